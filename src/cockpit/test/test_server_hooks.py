"""What is assumed of the private parts of viser and websockets."""

import dataclasses
import inspect
from unittest import mock

import msgspec
import pytest
import viser
import websockets.asyncio.server as library
from viser.infra import _infra

from cockpit.inbound import KINDS
from cockpit.page.connection_guard import listen
from cockpit.page.server_hooks import controls_of, form_of, replacing_server


@pytest.fixture(scope="module")
def started():
    """A server of viser, with the arguments that viser and then the hooks give to websockets."""
    listening = listen("127.0.0.1", 0)
    seen, serve = {}, library.serve

    def recorded(handler, **options):
        seen.update(options)
        return serve(handler, **options)

    with mock.patch.object(library, "serve", recorded), replacing_server(
        lambda handler, request: (handler, request), lambda: lambda message: True, 8, sock=listening
    ):
        assert library.serve is not recorded
        server = viser.ViserServer("127.0.0.1", listening.getsockname()[1], verbose=False)
        assert library.serve is not recorded
    yield server, seen, listening
    server.stop()


def test_viser_serves_with_one_call_that_is_replaced(started):
    server, options, listening = started
    assert options["sock"] is listening
    assert server.get_port() == listening.getsockname()[1]
    assert callable(options["process_request"]) and callable(options["create_connection"])
    assert library.serve.__module__.startswith("websockets"), "it is restored"


def test_viser_passes_the_request_handler_by_name():
    source = inspect.getsource(_infra)
    assert source.count("websockets.asyncio.server.serve(") == 1
    assert "process_request=" in source


def test_each_kind_of_message_is_a_dataclass_that_can_be_checked():
    for kind in sorted(KINDS):
        assert dataclasses.is_dataclass(form_of(kind)), kind
        with pytest.raises(msgspec.ValidationError):
            msgspec.convert({}, form_of(kind))


def test_the_controls_of_a_gui_are_known_by_id(started):
    server, *_ = started
    slider = server.gui.add_slider("speed", 0.0, 1.0, 0.1, 0.5)
    controls = controls_of(server.gui)
    assert slider in controls.values()
    slider.remove()
    assert slider not in controls.values(), "the same mapping follows"


def test_a_connection_of_websockets_has_the_methods_that_are_overridden():
    parameters = inspect.signature(library.ServerConnection.__init__).parameters
    assert list(parameters)[:3] == ["self", "protocol", "server"]
    assert inspect.iscoroutinefunction(library.ServerConnection.recv)
    assert list(inspect.signature(library.ServerConnection.connection_made).parameters) == [
        "self",
        "transport",
    ]
    assert inspect.iscoroutinefunction(library.ServerConnection.close)
    assert "self.handlers" in inspect.getsource(library.Server.__init__)
    assert "create_connection" in inspect.signature(library.serve).parameters
