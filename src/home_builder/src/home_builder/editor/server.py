"""The HTTP server of the editor's page, with the access checks of the cockpit."""

import re
import signal
import threading
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any, Callable, Dict, Optional, Tuple

from cockpit.access import OK, AccessPolicy
from home_builder.editor.session import EditorSession, as_json
from home_builder.editor.template import MAX_BYTES
from home_builder.editor.template import MEDIA as TEMPLATES
from home_builder.errors import EditorError
from planar import PlanarError

STATIC = Path(__file__).parent / "static"
KINDS = {".html": "html", ".js": "javascript", ".css": "css"}
PAGES = {f"/{path.name}": path for path in STATIC.iterdir() if path.suffix in KINDS}
PAGES["/"] = PAGES.pop("/editor.html")
MAX_BODY = 4 << 20
LONGEST = {"/template": MAX_BYTES}
# Seconds after which a connection that sends nothing is closed.
PATIENCE = 30.0
POLICY = "default-src 'self'; img-src 'self' data:; style-src 'self' 'unsafe-inline'; frame-ancestors {}"


ORIGIN = re.compile(r"https?://[\w.:\[\]-]+")


class EditorServer:
    """Serves the page of an editor session.

    Args:
        session: The plan.
        address: Address to bind.
        port: Port; 0 selects a free one.
        frame_of: Origin of the page that shows this one inside of it; empty: none may.

    Attributes:
        url: URL of the page, with its token.

    Raises:
        EditorError: The port is in use or not available, or ``frame_of`` is no origin.
    """

    def __init__(self, session: EditorSession, address: str = "127.0.0.1", port: int = 0, frame_of: str = ""):
        self._session = session
        if frame_of and not ORIGIN.fullmatch(frame_of):
            raise EditorError(
                f"--frame-of: expected an origin such as http://127.0.0.1:8700, got {frame_of!r}"
            )
        self._policy = POLICY.format(frame_of or "'none'")
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
        return _Handler(*request, session=self._session, access=self._access, policy=self._policy)

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
        policy: Content security policy of its pages.
    """

    timeout = PATIENCE

    def __init__(self, *args: Any, session: EditorSession, access: AccessPolicy, policy: str):
        self._session, self._access, self._policy = session, access, policy
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
            file = PAGES[path]
            self._send(HTTPStatus.OK, file.read_bytes(), f"text/{KINDS[file.suffix]}; charset=utf-8")
        elif path == "/plan":
            self._reply(lambda: as_json(self._session.state()))
        elif path == "/map.png":
            self._reply(self._session.map_picture, "image/png")
        elif path.startswith("/template_"):
            self._reply(lambda: self._session.template(path[1:]), TEMPLATES.get(Path(path).suffix[1:], ""))
        else:
            self._send(HTTPStatus.NOT_FOUND, b"no such page\n", "text/plain")

    def do_PUT(self) -> None:  # noqa: N802
        """Replace the plan or its template."""
        version = self.headers.get("If-Match")
        self._answer(
            {
                "/plan": lambda body: self._session.change(body.decode("utf-8"), version),
                "/template": self._session.set_template,
            }
        )

    def do_POST(self) -> None:  # noqa: N802
        """Build or try the home, or trace its template."""
        session = self._session
        actions = {
            "/build": session.build,
            "/try": session.try_out,
            "/drive": session.drive,
            "/trace": session.trace,
        }
        self._answer({path: lambda body, act=act: act() for path, act in actions.items()})  # type: ignore[misc]

    def _answer(self, actions: Dict[str, Callable[[bytes], Dict[str, Any]]]) -> None:
        if self._decision(changes=True) is None:
            return
        body = self._body()
        action = actions.get(self.path)
        if body is None or action is None:
            self._send(HTTPStatus.BAD_REQUEST, b'{"error": "not understood"}', "application/json")
            return
        self._reply(lambda: as_json(action(body)))

    def _reply(self, made: Callable[[], bytes], kind: str = "application/json") -> None:
        """Send what is made, or the error that prevents it."""
        try:
            self._send(HTTPStatus.OK, made(), kind)
        except (PlanarError, ValueError) as error:
            content = as_json({"error": str(error)})
            self._send(HTTPStatus.UNPROCESSABLE_ENTITY, content, "application/json")

    def _body(self) -> Optional[bytes]:
        """Return the body; None if it has no valid length."""
        length = self.headers.get("Content-Length", "0")
        if not length.isascii() or not length.isdigit() or int(length) > LONGEST.get(self.path, MAX_BODY):
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
            "Content-Security-Policy": self._policy,
            "X-Content-Type-Options": "nosniff",
            "Referrer-Policy": "no-referrer",
        }
        for name, value in {**fixed, **headers}.items():
            self.send_header(name, value)
        try:
            self.end_headers()
            self.wfile.write(content)
        except ConnectionError:  # the tab was closed meanwhile
            self.close_connection = True

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
