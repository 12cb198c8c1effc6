"""The HTTP server of the editor's page, with the access checks of the cockpit."""

import signal
import threading
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any, Callable, Dict, Optional, Tuple

from cockpit.access import OK, AccessPolicy
from home_builder.editor.session import EditorSession, as_json
from home_builder.errors import EditorError
from planar import PlanarError

STATIC = Path(__file__).parent / "static"
PAGES = {
    "/": ("editor.html", "text/html; charset=utf-8"),
    "/editor.js": ("editor.js", "text/javascript; charset=utf-8"),
    "/drawing.js": ("drawing.js", "text/javascript; charset=utf-8"),
    "/editor.css": ("editor.css", "text/css; charset=utf-8"),
}
MAX_BODY = 4 << 20
# Seconds after which a connection that sends nothing is closed.
PATIENCE = 30.0
POLICY = (
    "default-src 'self'; img-src 'self' data: blob:; style-src 'self' 'unsafe-inline'; frame-ancestors 'none'"
)


class EditorServer:
    """Serves the page of an editor session.

    Args:
        session: The plan.
        address: Address to bind.
        port: Port; 0 selects a free one.

    Attributes:
        url: URL of the page, with its token.

    Raises:
        EditorError: The port is in use or not available.
    """

    def __init__(self, session: EditorSession, address: str = "127.0.0.1", port: int = 0):
        self._session = session
        self._access: Optional[AccessPolicy] = None
        try:
            self._server = ThreadingHTTPServer((address, port), self._handle)
        except (OSError, OverflowError) as error:
            reason = getattr(error, "strerror", None) or str(error)
            raise EditorError(f"--web-port: {address}:{port} cannot be served ({reason})") from None
        self._server.daemon_threads = True
        port = self._server.server_address[1]
        self._access = AccessPolicy(port, (address,))
        self.url = f"http://{address}:{port}/?token={self._access.token}"

    def _handle(self, *request: Any) -> BaseHTTPRequestHandler:
        assert self._access is not None  # requests come only once the server serves
        return _Handler(*request, session=self._session, access=self._access)

    def serve(self) -> None:
        """Serve until ``close`` is called from another thread."""
        self._server.serve_forever(poll_interval=0.2)

    def serve_until_interrupted(self) -> None:
        """Serve until Ctrl-C."""
        thread = threading.Thread(target=self.serve, daemon=True)
        thread.start()
        interruption = threading.Event()
        signal.signal(signal.SIGINT, lambda *_: interruption.set())
        signal.signal(signal.SIGTERM, lambda *_: interruption.set())
        interruption.wait()
        self.close()

    def close(self) -> None:
        """Stop serving."""
        self._server.shutdown()
        self._server.server_close()
        self._session.close()


class _Handler(BaseHTTPRequestHandler):
    """Answers one request.

    Args:
        session: The plan.
        access: Decides on requests.
    """

    timeout = PATIENCE

    def __init__(self, *args: Any, session: EditorSession, access: AccessPolicy):
        self._session, self._access = session, access
        super().__init__(*args)

    def do_GET(self) -> None:  # noqa: N802 (name of http.server)
        """Answer with a file of the page, the plan, or the picture of the home."""
        decision = self._decision(changes=False)
        if decision is None:
            return
        path = self.path.partition("?")[0]
        if decision:
            self._send(HTTPStatus.SEE_OTHER, b"", "text/plain", {"Location": "/", "Set-Cookie": decision})
        elif path in PAGES:
            name, kind = PAGES[path]
            self._send(HTTPStatus.OK, (STATIC / name).read_bytes(), kind)
        elif path == "/plan":
            self._send(HTTPStatus.OK, as_json(self._session.state()), "application/json")
        else:
            self._send(HTTPStatus.NOT_FOUND, b"no such page\n", "text/plain")

    def do_PUT(self) -> None:  # noqa: N802
        """Replace the plan."""
        self._answer({"/plan": lambda body: self._session.change(body.decode("utf-8"))})

    def do_POST(self) -> None:  # noqa: N802
        """Build or try the home."""
        actions = {"/build": lambda body: self._session.build(), "/try": lambda body: self._session.try_out()}
        self._answer(actions)

    def _answer(self, actions: Dict[str, Callable[[bytes], Dict[str, Any]]]) -> None:
        if self._decision(changes=True) is None:
            return
        body = self._body()
        action = actions.get(self.path)
        if body is None or action is None:
            self._send(HTTPStatus.BAD_REQUEST, b'{"error": "not understood"}', "application/json")
            return
        try:
            self._send(HTTPStatus.OK, as_json(action(body)), "application/json")
        except (PlanarError, ValueError) as error:
            content = as_json({"error": str(error)})
            self._send(HTTPStatus.UNPROCESSABLE_ENTITY, content, "application/json")

    def _body(self) -> Optional[bytes]:
        """Return the body; None if it has no valid length."""
        length = self.headers.get("Content-Length", "0")
        if not length.isascii() or not length.isdigit() or int(length) > MAX_BODY:
            self.close_connection = True
            return None
        return self.rfile.read(int(length))

    def _decision(self, changes: bool) -> Optional[str]:
        """Return the cookie to set, or empty; None if the request was refused. Changes need an Origin."""
        headers = self.headers
        host, origin, cookies = headers.get("Host", ""), headers.get("Origin"), headers.get("Cookie", "")
        decision = self._access.judge(self.path, host, origin, cookies, is_socket=changes)
        if decision.status == OK:
            return decision.cookie
        self.close_connection = True
        self._send(HTTPStatus.FORBIDDEN, f"403: {decision.reason}\n".encode(), "text/plain")
        return None

    def _send(self, status: HTTPStatus, content: bytes, kind: str, headers: Dict[str, str] = {}) -> None:
        self.send_response(status)
        fixed = {
            "Content-Type": kind,
            "Content-Length": str(len(content)),
            "Cache-Control": "no-store",
            "Content-Security-Policy": POLICY,
            "X-Content-Type-Options": "nosniff",
            "Referrer-Policy": "no-referrer",
        }
        for name, value in {**fixed, **headers}.items():
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(content)

    def log_message(self, format: str, *args: Any) -> None:  # noqa: A002
        """Requests are not logged."""


def address_and_port(text: str) -> Tuple[str, int]:
    """Return address and port of ``[ADDRESS:]PORT``.

    Raises:
        EditorError: The text is no port.
    """
    address, _, port = text.rpartition(":")
    if not port.isascii() or not port.isdigit() or int(port) > 65535:
        raise EditorError(f"--web-port: expected [ADDRESS:]PORT, got {text}")
    return address.strip("[]") or "127.0.0.1", int(port)
