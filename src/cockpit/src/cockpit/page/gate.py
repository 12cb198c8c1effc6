"""The gate before viser's server: who comes in, how many, and what they may send.

viser 1.1 has no hook for any of this; but it serves page and socket by one call of ``websockets``' server,
and that call is given another socket, a check before viser's own, and connections that check what they
receive. The version of viser is pinned, and test_gate.py tries it all on the real server.
"""

import logging
import resource
import socket
import time
from contextlib import contextmanager
from http import HTTPStatus
from typing import Any, Callable, Iterator

import msgspec.msgpack
import websockets.asyncio.server as library
from websockets.exceptions import ConnectionClosed

from cockpit.access import OK, SEE_OTHER, Access
from cockpit.errors import PortError, RefusedError
from cockpit.inbound import LARGEST_MESSAGE, Allowance, check

MOST_PAGES = 32
OPEN_FILES = 4096
POLICY = (
    "default-src 'self'; connect-src 'self' ws: data: blob:; img-src 'self' data: blob:; "
    "font-src 'self' data:; style-src 'self' 'unsafe-inline'; worker-src 'self' blob: data:; "
    "script-src 'self' 'unsafe-inline' 'unsafe-eval' 'wasm-unsafe-eval' blob: data:; frame-ancestors 'none'"
)


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


class Gate:
    """Stands before what is served on ``listening`` from within ``guarding()``."""

    def __init__(self, listening: socket.socket, access: Access):
        self._socket, self._access = listening, access
        self._pages = 0
        _allow_open_files()
        # It would print the traceback of every request that is refused.
        logging.getLogger("websockets.server").setLevel(logging.CRITICAL)

    @contextmanager
    def guarding(self) -> Iterator[None]:
        """The server that is started within is served through this gate."""
        serve = library.serve

        def guarded(handler, _host, _port, *, process_request, **options):
            options.update(max_size=LARGEST_MESSAGE, create_connection=_Connection, sock=self._socket)
            return serve(self._seeing_out(handler), process_request=self._before(process_request), **options)

        library.serve = guarded  # type: ignore[assignment, misc]
        try:
            yield
        finally:
            library.serve = serve  # type: ignore[misc]

    def _before(self, process_request: Callable) -> Callable:
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
            if answer.status == SEE_OTHER:
                response = connection.respond(HTTPStatus.SEE_OTHER, "")
                response.headers["Location"] = "/"
                response.headers["Set-Cookie"] = answer.cookie
                return response
            if answer.status != OK:
                return connection.respond(HTTPStatus.FORBIDDEN, f"403: {answer.reason}\n")
            if is_socket and self._pages >= MOST_PAGES:
                return connection.respond(HTTPStatus.SERVICE_UNAVAILABLE, "too many pages are open\n")
            return _with_policy(process_request(connection, request))

        return judged

    def _seeing_out(self, handler: Callable) -> Callable:
        """Whatever a page sends, it is the end of its own connection only."""

        async def seen_out(connection) -> None:
            self._pages += 1
            try:
                await handler(connection)
            except ConnectionClosed:
                raise
            except Exception:  # viser's handler lets pass whatever msgspec raises
                await connection.close(1003, "not understood")
            finally:
                self._pages -= 1

        return seen_out


class _Connection(library.ServerConnection):
    """Passes on what a page may send; closes at the first thing that it may not."""

    def __init__(self, *arguments: Any, **options: Any):
        super().__init__(*arguments, **options)
        self._allowance = Allowance()

    async def recv(self, *arguments: Any, **options: Any):
        message = await super().recv(*arguments, **options)
        if not self._allowance.take(time.monotonic()):
            await self.close(1008, "too many messages")
            return await super().recv(*arguments, **options)
        try:
            check(msgspec.msgpack.decode(message))  # type: ignore[arg-type]  # text raises TypeError
        except (RefusedError, msgspec.DecodeError, TypeError) as error:
            await self.close(1003, str(error)[:100])
            return await super().recv(*arguments, **options)
        return message


def _with_policy(response):
    """The page may load nothing from elsewhere, and nobody may frame it."""
    if response is not None:
        response.headers["Content-Security-Policy"] = POLICY
        response.headers["X-Content-Type-Options"] = "nosniff"
        response.headers["Referrer-Policy"] = "no-referrer"
    return response


def _allow_open_files() -> None:
    """So many that a thousand connections leave some for ROS."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    wanted = OPEN_FILES if hard == resource.RLIM_INFINITY else min(OPEN_FILES, hard)
    if soft != resource.RLIM_INFINITY and soft < wanted:
        resource.setrlimit(resource.RLIMIT_NOFILE, (wanted, hard))
