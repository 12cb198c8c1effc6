"""Access to the HTTP interface: a token, and checks of the Host and Origin headers against other sites."""

import hmac
import secrets
from typing import Any, Awaitable, Callable, Dict, Optional, Tuple
from urllib.parse import parse_qs, urlsplit

LOOPBACK = ("127.0.0.1", "localhost", "::1")
# Paths without a token: the schema holds nothing of the home.
OPEN_PATHS = ("/openapi.json",)
Receive = Callable[[], Awaitable[Any]]
Send = Callable[[Any], Awaitable[None]]


def new_token() -> str:
    """Return a random token."""
    return secrets.token_urlsafe(24)


class AccessGuard:
    """ASGI middleware that rejects requests without the token.

    The token is in the header ``Authorization: Bearer TOKEN`` or the query ``token=TOKEN``. The Host header
    reveals a site whose name resolves to this machine (DNS rebinding), the Origin header a page of another
    site.

    Args:
        app: The application.
        token: The token.
        hosts: Further names of this machine.
    """

    def __init__(self, app: Any, token: str, hosts: Tuple[str, ...] = ()):
        self._app, self._token, self._hosts = app, token, {*LOOPBACK, *hosts}

    async def __call__(self, scope: Dict[str, Any], receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            return
        refusal = self.refusal(scope)
        if refusal is None:
            await self._app(scope, receive, send)
            return
        status, text = refusal
        body = f'{{"problems": ["{text}"]}}'.encode()
        headers = [(b"content-type", b"application/json"), (b"content-length", str(len(body)).encode())]
        if status == 401:
            headers.append((b"www-authenticate", b"Bearer"))
        await send({"type": "http.response.start", "status": status, "headers": headers})
        await send({"type": "http.response.body", "body": body})

    def refusal(self, scope: Dict[str, Any]) -> Optional[Tuple[int, str]]:
        """Return status and reason with which a request is rejected; None to accept it."""
        headers = {name: value.decode("latin-1") for name, value in scope["headers"]}
        host = headers.get(b"host", "")
        if _host_name(host) not in self._hosts:
            return 403, "this name is not one of the service"
        origin = headers.get(b"origin")
        if origin is not None and origin != f"http://{host}":
            return 403, "requested by a page of another site"
        if scope["path"] in OPEN_PATHS:
            return None
        scheme, _, token = headers.get(b"authorization", "").partition(" ")
        if scheme.lower() != "bearer":
            token = parse_qs(scope["query_string"].decode("latin-1")).get("token", [""])[0]
        if not hmac.compare_digest(token.encode(), self._token.encode()):
            return 401, "the token is missing or wrong; it is in service.json in the folder of the service"
        return None


def _host_name(host: str) -> Optional[str]:
    try:
        return urlsplit(f"//{host}").hostname
    except ValueError:
        return None
