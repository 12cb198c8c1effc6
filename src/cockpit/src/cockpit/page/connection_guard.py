"""Access checks, connection limits and message checks in front of the server of viser.

The server gets our socket, a check before viser's own, and connections that check each message;
test_connection_guard.py tests this module with the real server.
"""

import logging
import socket
import time
from http import HTTPStatus
from typing import Any, Callable, ContextManager, Mapping, Tuple

import msgspec
from websockets.exceptions import ConnectionClosed

from cockpit.access import OK, AccessPolicy
from cockpit.errors import PortError, RefusedError
from cockpit.inbound import KINDS, LARGEST_MESSAGE, RateLimiter, check
from cockpit.page.controls import accepts
from cockpit.page.server_hooks import ClosingError, controls_of, form_of, replacing_server
from supervision.open_files import allow_open_files

MOST_PAGES = 32
OPEN_FILES = 4096  # a thousand connections leave enough for ROS
MOST_REASON = 100  # bytes of a closing reason; the protocol allows a few more
# The fields of each message kind.
FORMS = {kind: form_of(kind) for kind in KINDS}
POLICY = (
    "default-src 'self'; connect-src 'self' ws: data: blob:; img-src 'self' data: blob:; "
    "font-src 'self' data:; style-src 'self' 'unsafe-inline'; worker-src 'self' blob: data:; "
    "script-src 'self' 'unsafe-inline' 'unsafe-eval' 'wasm-unsafe-eval' blob: data:; "
    "frame-src http://127.0.0.1:* http://localhost:*; frame-ancestors 'none'"  # the editor of homes
)
# Redirects to the page. Without a graphics card it asks for a quarter of the pixels, to draw in time.
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
    """Open a listening socket.

    Args:
        address: Address to bind.
        port: Port; 0 selects a free one.

    Raises:
        PortError: The address is in use or not available.
    """
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
    """Checks the requests and messages to a server that is started within ``guarding()``.

    Args:
        listening: Socket that the server uses.
        access: Decides on requests.
    """

    def __init__(self, listening: socket.socket, access: AccessPolicy):
        self._socket, self._access = listening, access
        self._pages = 0
        self._controls: Mapping[str, Any] = {}
        # The other half of the files is left for ROS.
        self._most_connections = allow_open_files(OPEN_FILES) // 2
        # It would print a traceback for every rejected request.
        logging.getLogger("websockets.server").setLevel(logging.CRITICAL)

    def set_controls(self, gui: Any) -> None:
        """Set the gui of viser, whose controls define which values are accepted."""
        self._controls = controls_of(gui)

    def guarding(self) -> ContextManager[None]:
        """Return a context in which the server that is started is guarded."""
        return replacing_server(
            self._guarded,
            lambda: _MessageCheck(self._is_acceptable),
            self._most_connections,
            max_size=LARGEST_MESSAGE,
            sock=self._socket,
        )

    def _guarded(self, handler: Callable, process_request: Callable) -> Tuple[Callable, Callable]:
        return self._closing_on_error(handler), self._checked(process_request)

    def _is_acceptable(self, message: Mapping[str, Any]) -> bool:
        """Messages for controls that no longer exist are passed on: controls come and go."""
        control = self._controls.get(message.get("uuid", ""))
        return control is None or all(accepts(control, each) for each in message.get("updates", {}).values())

    def _checked(self, process_request: Callable) -> Callable:
        """Wrap the request handler with the access check."""

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
        """Close only the connection whose message raises an error."""

        async def handled(connection) -> None:
            self._pages += 1
            try:
                await handler(connection)
            except ConnectionClosed:
                raise
            except Exception:  # the handler of viser does not catch the errors of msgspec
                await connection.close(1003, "not understood")
            finally:
                self._pages -= 1

        return handled


class _MessageCheck:
    """Check of the messages of one connection: their rate, their form, and the values of controls."""

    def __init__(self, is_acceptable: Callable[[Mapping[str, Any]], bool]):
        self._is_acceptable = is_acceptable
        self._rate_limiter = RateLimiter()

    def __call__(self, message: Any) -> bool:
        """Return whether a message is passed on. Raises ClosingError."""
        if not self._rate_limiter.allow(time.monotonic()):
            raise ClosingError(1008, "too many messages")
        try:
            content = _read(message)
        except (RefusedError, msgspec.MsgspecError, TypeError) as error:
            raise ClosingError(1003, str(error).encode()[:MOST_REASON].decode(errors="ignore")) from None
        return self._is_acceptable(content)


def _read(message: Any) -> Mapping[str, Any]:
    """Decode and check a message. Raises RefusedError, MsgspecError, or TypeError for text."""
    content = msgspec.msgpack.decode(message)
    check(content)
    msgspec.convert(content, FORMS[content["type"]])
    return content


def _start(connection, cookie: str):
    response = connection.respond(HTTPStatus.OK, START)
    del response.headers["Content-Type"]
    response.headers["Content-Type"] = "text/html; charset=utf-8"
    response.headers["Cache-Control"] = "no-store"
    response.headers["Set-Cookie"] = cookie
    return response


def _with_policy(response):
    """Add headers that forbid foreign resources and framing."""
    if response is not None:
        response.headers["Content-Security-Policy"] = POLICY
        response.headers["X-Content-Type-Options"] = "nosniff"
        response.headers["Referrer-Policy"] = "no-referrer"
    return response
