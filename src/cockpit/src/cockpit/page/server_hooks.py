"""Private parts of viser and websockets; no other module uses them.

viser 1.1 has no hooks for a socket of ours and for checks of requests and messages, but it serves page and
socket with one call of ``websockets``, which is replaced while viser starts. viser and websockets are pinned;
test_server_hooks.py checks what is assumed of them.
"""

from contextlib import contextmanager
from functools import partial
from typing import Any, Callable, Iterator, Mapping, Tuple

import websockets.asyncio.server as library
from viser import _messages as forms

# Returns whether a message is passed on; it may raise ClosingError. One for each connection.
Accepts = Callable[[Any], bool]
Handler = Callable[..., Any]
ProcessRequest = Callable[..., Any]


class ClosingError(Exception):
    """The connection whose message raises it is closed.

    Args:
        code: Code of RFC 6455.
        reason: At most 123 bytes.
    """

    def __init__(self, code: int, reason: str):
        super().__init__(reason)
        self.code, self.reason = code, reason


def form_of(kind: str) -> type:
    """Return the dataclass of a kind of message; needed to check types, as viser converts without a check."""
    form: type = getattr(forms, kind)
    return form


def controls_of(gui: Any) -> Mapping[str, Any]:
    """Return the present controls of a gui by id; needed to check a value before viser uses it."""
    controls: Mapping[str, Any] = gui._gui_input_handle_from_uuid
    return controls


@contextmanager
def replacing_server(
    wrap: Callable[[Handler, ProcessRequest], Tuple[Handler, ProcessRequest]],
    make_check: Callable[[], Accepts],
    most_connections: int,
    **options: Any,
) -> Iterator[None]:
    """Change the server that viser starts in this context.

    Args:
        wrap: Takes and returns the handler of a connection and that of a request.
        make_check: Makes the check of the messages of a connection.
        most_connections: Number of simultaneous connections; further ones are aborted.
        options: Options of ``websockets.asyncio.server.serve`` that replace those of viser; ``sock`` replaces
            address and port.
    """
    serve = library.serve
    connection = partial(_Connection, most=most_connections, accepts_of=make_check)

    def replaced(handler: Handler, _host: str, _port: int, *, process_request: ProcessRequest, **given: Any):
        handler, process_request = wrap(handler, process_request)
        given.update(options, create_connection=connection)
        return serve(handler, process_request=process_request, **given)

    library.serve = replaced  # type: ignore[assignment, misc]
    try:
        yield
    finally:
        library.serve = serve  # type: ignore[misc]


class _Connection(library.ServerConnection):
    """Passes accepted messages on and closes at the first invalid one."""

    def __init__(self, *arguments: Any, most: int, accepts_of: Callable[[], Accepts], **options: Any):
        super().__init__(*arguments, **options)
        self._most, self._accepts = most, accepts_of()

    def connection_made(self, transport: Any) -> None:
        super().connection_made(transport)
        if len(self.server.handlers) > self._most:
            transport.abort()

    async def recv(self, *arguments: Any, **options: Any):
        while True:
            message = await super().recv(*arguments, **options)
            try:
                if self._accepts(message):
                    return message
            except ClosingError as error:
                await self.close(error.code, error.reason)  # recv then raises ConnectionClosed
