"""The connection guard with the real server: access, limits and malformed messages."""

import contextlib
import http.client
import socket
import subprocess
import sys
import time

import msgspec.msgpack
import psutil
import pytest
import viser
from websockets.exceptions import ConnectionClosed, InvalidHandshake
from websockets.sync.client import connect

from cockpit.errors import PortError
from cockpit.page.connection_guard import MOST_PAGES, listen
from cockpit.page.server import Page

DEADLINE = 30.0
CAMERA = {
    "type": "ViewerCameraMessage",
    "wxyz": [1.0, 0.0, 0.0, 0.0],
    "position": [0.0, 0.0, 5.0],
    "fov": 1.0,
    "near": 0.1,
    "far": 100.0,
    "image_height": 600,
    "image_width": 800,
    "look_at": [0.0, 0.0, 0.0],
    "up_direction": [0.0, 0.0, 1.0],
}
DRAG = {
    "type": "SceneNodeDragMessage",
    "phase": "start",
    "name": "/floor/slab",
    "instance_index": None,
    "start_position": [0.0, 0.0, 0.0],
    "start_screen_pos": [0.0, 0.0],
    "end_position": [0.0, 0.0, 0.0],
    "end_screen_pos": [0.0, 0.0],
    "button": "left",
    "modifier": None,
    "owner": "server",
}
FEW_FILES = 1024
WITH_FEW_FILES = f"""
import resource, time
from cockpit.page.server import Page
resource.setrlimit(resource.RLIMIT_NOFILE, ({FEW_FILES}, {FEW_FILES}))
print(Page("127.0.0.1", 0).url.split(":")[2].split("/")[0], flush=True)
time.sleep(60.0)
"""


@pytest.fixture(scope="module")
def page():
    page = Page("127.0.0.1", 0)
    yield page
    page.close()


@pytest.fixture
def port(page):
    return int(page.url.split(":")[2].split("/")[0])


@pytest.fixture
def cookie(page, port):
    return f"cockpit_{port}={page.url.partition('token=')[2]}"


def get(port, target="/", **headers):
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=DEADLINE)
    connection.request("GET", target, headers=headers)
    answer = connection.getresponse()
    content = answer.read()
    connection.close()
    return answer, content


def open_page(port, cookie, origin=None, host=None):
    """A socket as a browser's page opens it."""
    origin = f"http://127.0.0.1:{port}" if origin is None else origin
    return connect(
        f"ws://127.0.0.1:{port}/",
        origin=origin or None,
        additional_headers={"Cookie": cookie} if cookie else {},
        subprotocols=[f"viser-v{viser.__version__}"],
        max_size=None,
        open_timeout=DEADLINE,
        close_timeout=0.2,  # it does not read all that it is sent
    )


def wait_until(holds):
    deadline = time.monotonic() + DEADLINE
    while not holds():
        assert time.monotonic() < deadline
        time.sleep(0.02)


def is_shown(page, port, cookie):
    """Whether a page that behaves is still served."""
    with open_page(port, cookie) as socket_:
        socket_.send(msgspec.msgpack.encode(CAMERA))
        return len(socket_.recv(timeout=DEADLINE)) > 0


def closing_code(socket_):
    """None if the close frame is lost, as when the server closes with unread data."""
    with pytest.raises(ConnectionClosed) as closed:
        while True:
            socket_.recv(timeout=DEADLINE)
    return closed.value.rcvd.code if closed.value.rcvd else None


def test_the_url_leads_to_the_page_by_way_of_a_cookie(page, port):
    answer, content = get(port, page.url.partition(str(port))[2])
    assert (answer.status, answer.headers["Content-Type"]) == (200, "text/html; charset=utf-8")
    assert b"location.replace" in content
    assert answer.headers["Cache-Control"] == "no-store"
    assert answer.headers["Referrer-Policy"] == "no-referrer"
    cookie = answer.headers["Set-Cookie"].partition(";")[0]
    answer, content = get(port, Cookie=cookie)
    assert answer.status == 200
    assert b"<html" in content
    assert "frame-ancestors 'none'" in answer.headers["Content-Security-Policy"]


@pytest.mark.parametrize("target", ["/", "/index.html", "/?token=wrong", "/assets/../index.html"])
def test_without_the_token_not_even_the_page_is_sent(port, target):
    assert get(port, target)[0].status == 403


def test_a_foreign_host_or_origin_is_refused_in_spite_of_the_cookie(port, cookie):
    assert get(port, Cookie=cookie, Host="evil.example")[0].status == 403
    assert get(port, Cookie=cookie, Origin="http://evil.example")[0].status == 403


@pytest.mark.parametrize("origin", ["http://evil.example", ""])
def test_a_socket_of_another_page_or_of_none_is_refused(port, cookie, origin):
    with pytest.raises(InvalidHandshake, match="403"):
        open_page(port, cookie, origin)


def test_a_socket_without_the_cookie_is_refused(port):
    with pytest.raises(InvalidHandshake, match="403"):
        open_page(port, "")


def test_who_has_the_cookie_is_shown_the_page_and_counts_as_watching(page, port, cookie):
    with open_page(port, cookie) as socket_:
        socket_.send(msgspec.msgpack.encode(CAMERA))
        wait_until(lambda: page.is_watched)
    wait_until(lambda: not page.is_watched)


@pytest.mark.parametrize(
    ("sent", "code"),
    [
        (b"\xff\x00garbage", 1003),
        ("text", 1003),
        (msgspec.msgpack.encode({"type": "ShareUrlRequest"}), 1003),
        (msgspec.msgpack.encode({**CAMERA, "position": [float("nan"), 0.0, 0.0]}), 1003),
        (msgspec.msgpack.encode({"type": "ViewerCameraMessage"}), 1003),
        (msgspec.msgpack.encode({**CAMERA, "position": [0.0, 0.0]}), 1003),
        (msgspec.msgpack.encode({**CAMERA, "fov": "wide"}), 1003),
        (msgspec.msgpack.encode({"type": "CommandTriggerMessage", "uuid": {"__binary_index": 9}}), 1003),
        (msgspec.msgpack.encode({**DRAG, "button": "\N{SNOWMAN}" * 200}), 1003),
        (b"\x00" * 10_000_000, 1009),
    ],
    ids=[
        "garbage",
        "text",
        "sharing",
        "nan",
        "incomplete",
        "too short",
        "no number",
        "no name",
        "no button",
        "10 MB",
    ],
)
def test_nonsense_ends_the_connection_that_sent_it_and_no_other(page, port, cookie, sent, code):
    with open_page(port, cookie) as good, open_page(port, cookie) as bad:
        good.send(msgspec.msgpack.encode(CAMERA))
        with contextlib.suppress(ConnectionClosed):
            bad.send(sent)
        assert closing_code(bad) == code
        good.send(msgspec.msgpack.encode(CAMERA))
        assert good.recv(timeout=DEADLINE)


def test_a_flood_of_messages_ends_the_connection(page, port, cookie):
    with open_page(port, cookie) as bad:
        message = msgspec.msgpack.encode(CAMERA)
        with contextlib.suppress(ConnectionClosed):
            for _ in range(20_000):
                bad.send(message)
        assert closing_code(bad) in (1008, None)
    assert is_shown(page, port, cookie)


def update(control, value):
    """The message of a page for a changed control."""
    message = {"type": "GuiUpdateMessage", "uuid": control._impl.uuid, "updates": {"value": value}}
    return msgspec.msgpack.encode(message)


@pytest.mark.parametrize(
    ("kind", "value"),
    [
        ("slider", "nan"),
        ("slider", 1e6),
        ("slider", [1.0]),
        ("number", "9" * 40),
        ("number", 1e300),
        ("list", "/cmd_vel of another"),
        ("box", "yes"),
        ("text", 5),
        ("text", None),
    ],
)
def test_a_value_that_its_control_cannot_have_changes_nothing(page, port, cookie, kind, value):
    controls = {
        "slider": page.gui.add_slider("a", 0.0, 2.0, 0.1, 1.0),
        "number": page.gui.add_number("b", 3),
        "list": page.gui.add_dropdown("c", ("/cmd_vel",)),
        "box": page.gui.add_checkbox("d", False),
        "text": page.gui.add_text("e", "before"),
        "last": page.gui.add_text("f", "before"),
    }
    before = controls[kind].value
    with open_page(port, cookie) as sender:
        sender.send(msgspec.msgpack.encode(CAMERA))
        sender.send(update(controls[kind], value))
        sender.send(update(controls["last"], "after"))
        wait_until(lambda: controls["last"].value == "after")
        assert controls[kind].value == before
    assert is_shown(page, port, cookie)
    for control in controls.values():
        control.remove()


def test_so_many_pages_and_no_more(page, port, cookie):
    with contextlib.ExitStack() as stack, pytest.raises(InvalidHandshake, match="503"):
        for _ in range(MOST_PAGES + 1):
            stack.enter_context(open_page(port, cookie))
    wait_until(lambda: _opens(port, cookie))


def _opens(port, cookie):
    try:
        open_page(port, cookie).close()
    except InvalidHandshake:
        return False
    return True


def test_a_thousand_silent_connections_leave_the_page_alive(page, port, cookie):
    with contextlib.ExitStack() as stack:
        for _ in range(1000):
            stack.enter_context(socket.create_connection(("127.0.0.1", port), DEADLINE))
        assert get(port, Cookie=cookie)[0].status == 200
        assert is_shown(page, port, cookie)


def test_so_many_connections_that_files_are_left_for_ros():
    server = subprocess.Popen([sys.executable, "-c", WITH_FEW_FILES], stdout=subprocess.PIPE, text=True)
    with contextlib.ExitStack() as stack:
        stack.callback(server.wait)
        stack.callback(server.kill)
        port = int(server.stdout.readline())
        held = psutil.Process(server.pid)
        most, deadline = 0, time.monotonic() + DEADLINE
        while most <= FEW_FILES // 2:  # silent connections time out, on a busy machine before all are open
            assert time.monotonic() < deadline
            most = max(most, _most_files(held, port))
        assert most < 0.75 * FEW_FILES


def _most_files(held, port):
    """So many are open at the server's while ever more connect to it, and in the second after."""
    most = 0
    with contextlib.ExitStack() as stack:
        for _ in range(FEW_FILES):
            stack.enter_context(socket.create_connection(("127.0.0.1", port), DEADLINE))
            most = max(most, held.num_fds())
        for _ in range(20):
            time.sleep(0.05)
            most = max(most, held.num_fds())
    return most


def test_it_listens_on_the_loopback_alone(port):
    listening = [found for found in psutil.Process().net_connections("tcp") if found.status == "LISTEN"]
    assert {found.laddr.ip for found in listening if found.laddr.port == port} == {"127.0.0.1"}


def test_a_busy_port_is_an_error_and_not_silently_the_next_one(port):
    with pytest.raises(PortError, match=f"127.0.0.1:{port} cannot be served"):
        Page("127.0.0.1", port)


@pytest.mark.parametrize("address", ["192.0.2.1", "nowhere.invalid"])
def test_an_address_that_is_not_of_this_machine_is_an_error(address):
    with pytest.raises(PortError, match="cannot be served"):
        listen(address, 0)
