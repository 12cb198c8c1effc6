"""The gate before viser's server: who comes in, how many, and what they may send.

viser 1.1 has no hook for any of this; but it serves page and socket by one call of ``websockets``' server,
and that call is given another socket, a check before viser's own, and connections that check what they
receive. The version of viser is pinned, and test_gate.py tries it all on the real server.
"""

import logging
import socket
import time
from contextlib import contextmanager
from functools import partial
from http import HTTPStatus
from typing import Any, Callable, Iterator, Mapping

import msgspec
import websockets.asyncio.server as library
from viser import _messages as forms
from websockets.exceptions import ConnectionClosed

from cockpit.access import OK, AccessPolicy
from cockpit.errors import PortError, RefusedError
from cockpit.inbound import KINDS, LARGEST_MESSAGE, RateLimiter, check
from cockpit.page.controls import accepts
from supervision.open_files import allow_open_files

MOST_PAGES = 32
OPEN_FILES = 4096  # so many that a thousand connections leave some for ROS
MOST_REASON = 100  # bytes of why a connection is closed: the protocol has room for some more
# What each kind of message consists of.
FORMS = {kind: getattr(forms, kind) for kind in KINDS}
POLICY = (
    "default-src 'self'; connect-src 'self' ws: data: blob:; img-src 'self' data: blob:; "
    "font-src 'self' data:; style-src 'self' 'unsafe-inline'; worker-src 'self' blob: data:; "
    "script-src 'self' 'unsafe-inline' 'unsafe-eval' 'wasm-unsafe-eval' blob: data:; frame-ancestors 'none'"
)
# Leads on to the page. Without a graphics card a quarter of the pixels is what a page can draw in time.
START = """<!doctype html>
<html lang="en">
<title>Cockpit</title>
<noscript>The cockpit needs JavaScript.</noscript>
<script>
    const gl = document.createElement("canvas").getContext("webgl2");
    const named = gl && gl.getExtension("WEBGL_debug_renderer_info");
    const renderer = named ? gl.getParameter(named.UNMASKED_RENDERER_WEBGL) : "";
    location.replace(/swiftshader|llvmpipe|softpipe|software/i.test(renderer) ? "/?fixedDpr=0.5" : "/");
</script>
"""


def listen(address: str, port: int) -> socket.socket:
    """A socket that listens there and nowhere else. Raises PortError."""
    family = socket.AF_INET6 if ":" in address else socket.AF_INET
    listening = socket.socket(family, socket.SOCK_STREAM)
    listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listening.bind((address, port))
        listening.listen(128)
    except (OSError, OverflowError) as error:
        listening.close()
        reason = getattr(error, "strerror", None) or str(error)
        raise PortError(f"--web-port: {address}:{port} cannot be served ({reason})") from None
    return listening


class ConnectionGuard:
    """Stands before what is served on ``listening`` from within ``guarding()``."""

    def __init__(self, listening: socket.socket, access: AccessPolicy):
        self._socket, self._access = listening, access
        self._pages = 0
        self._controls: Mapping[str, Any] = {}
        # The other half is for ROS, which needs files too.
        self._most_connections = allow_open_files(OPEN_FILES) // 2
        # It would print the traceback of every request that is refused.
        logging.getLogger("websockets.server").setLevel(logging.CRITICAL)

    def set_controls(self, gui: Any) -> None:
        """Whose controls get only such values as they can have: viser's ``gui``."""
        self._controls = gui._gui_input_handle_from_uuid

    @contextmanager
    def guarding(self) -> Iterator[None]:
        """The server that is started within is served through this gate."""
        serve = library.serve

        def guarded(handler, _host, _port, *, process_request, **options):
            connection = partial(_Connection, most=self._most_connections, is_acceptable=self._is_of_use)
            options.update(max_size=LARGEST_MESSAGE, create_connection=connection, sock=self._socket)
            return serve(
                self._closing_on_error(handler), process_request=self._checked(process_request), **options
            )

        library.serve = guarded  # type: ignore[assignment, misc]
        try:
            yield
        finally:
            library.serve = serve  # type: ignore[misc]

    def _is_of_use(self, message: Mapping[str, Any]) -> bool:
        """Controls come and go, so that a page may well speak of one as it was."""
        control = self._controls.get(message.get("uuid", ""))
        return control is None or all(accepts(control, each) for each in message.get("updates", {}).values())

    def _checked(self, process_request: Callable) -> Callable:
        """What judges a request before viser sees it."""

        def judged(connection, request):
            headers = request.headers
            is_socket = headers.get("Upgrade", "").lower() == "websocket"
            several = [name for name in ("Host", "Origin") if len(headers.get_all(name)) > 1]
            if several:
                return connection.respond(HTTPStatus.BAD_REQUEST, f"more than one {several[0]}\n")
            cookies = "; ".join(headers.get_all("Cookie"))
            answer = self._access.judge(
                request.path, headers.get("Host", ""), headers.get("Origin"), cookies, is_socket
            )
            if answer.status != OK:
                return connection.respond(HTTPStatus.FORBIDDEN, f"403: {answer.reason}\n")
            if answer.cookie:
                return _with_policy(_start(connection, answer.cookie))
            if is_socket and self._pages >= MOST_PAGES:
                return connection.respond(HTTPStatus.SERVICE_UNAVAILABLE, "too many pages are open\n")
            return _with_policy(process_request(connection, request))

        return judged

    def _closing_on_error(self, handler: Callable) -> Callable:
        """Whatever a page sends, it is the end of its own connection only."""

        async def handled(connection) -> None:
            self._pages += 1
            try:
                await handler(connection)
            except ConnectionClosed:
                raise
            except Exception:  # viser's handler lets pass whatever msgspec raises
                await connection.close(1003, "not understood")
            finally:
                self._pages -= 1

        return handled


class _Connection(library.ServerConnection):
    """Passes on what a page may send; closes at the first thing that it may not."""

    def __init__(
        self, *arguments: Any, most: int, is_acceptable: Callable[[Mapping[str, Any]], bool], **options: Any
    ):
        super().__init__(*arguments, **options)
        self._most, self._is_of_use = most, is_acceptable
        self._rate_limiter = RateLimiter()

    def connection_made(self, transport: Any) -> None:
        super().connection_made(transport)
        if len(self.server.handlers) > self._most:
            transport.abort()

    async def recv(self, *arguments: Any, **options: Any):
        while True:
            message = await super().recv(*arguments, **options)
            if not self._rate_limiter.allow(time.monotonic()):
                await self.close(1008, "too many messages")
                continue  # which raises that it is closed
            try:
                told = _read(message)
            except (RefusedError, msgspec.MsgspecError, TypeError) as error:
                await self.close(1003, str(error).encode()[:MOST_REASON].decode(errors="ignore"))
                continue
            if self._is_of_use(told):
                return message


def _read(message: Any) -> Mapping[str, Any]:
    """Raises RefusedError, msgspec's errors, or for text TypeError."""
    told = msgspec.msgpack.decode(message)
    check(told)
    msgspec.convert(told, FORMS[told["type"]])
    return told


def _start(connection, cookie: str):
    response = connection.respond(HTTPStatus.OK, START)
    del response.headers["Content-Type"]
    response.headers["Content-Type"] = "text/html; charset=utf-8"
    response.headers["Cache-Control"] = "no-store"
    response.headers["Set-Cookie"] = cookie
    return response


def _with_policy(response):
    """The page may load nothing from elsewhere, and nobody may frame it."""
    if response is not None:
        response.headers["Content-Security-Policy"] = POLICY
        response.headers["X-Content-Type-Options"] = "nosniff"
        response.headers["Referrer-Policy"] = "no-referrer"
    return response
