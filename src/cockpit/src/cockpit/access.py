"""Access control of the page: a token, and checks of the Host and Origin headers."""

import hmac
import secrets
from dataclasses import dataclass
from http.cookies import CookieError, SimpleCookie
from typing import Optional, Tuple
from urllib.parse import parse_qs, urlsplit

LOOPBACK = ("127.0.0.1", "localhost", "::1")
OK, FORBIDDEN = 200, 403


@dataclass(frozen=True)
class AccessDecision:
    """The decision on a request.

    Attributes:
        status: 200 to accept, 403 to reject.
        reason: Why the request is rejected.
        cookie: A cookie to set with a redirect to the page, or empty.
    """

    status: int
    reason: str = ""
    cookie: str = ""


class AccessPolicy:
    """Decides on requests by token, cookie, Host and Origin.

    The token is in the URL that the terminal prints; the first request exchanges it for a cookie and is
    redirected to a URL without it. The Host header reveals a site whose name resolves to this machine (DNS
    rebinding), the Origin header a page of another site.

    Args:
        port: Port of the page; part of the cookie's name, since browsers share cookies between ports.
        hosts: Further names and addresses of this machine.
        token: Token of the URL; None for a random one.

    Attributes:
        token: Token of the URL.
    """

    def __init__(self, port: int, hosts: Tuple[str, ...] = LOOPBACK, token: Optional[str] = None):
        self.token = token or secrets.token_urlsafe(24)
        self._hosts = {*LOOPBACK, *hosts}
        # Cookies are not separated by port: two cockpits on one machine need different names.
        self._cookie = f"cockpit_{port}"

    def judge(
        self, target: str, host: str, origin: Optional[str], cookies: str, is_socket: bool
    ) -> AccessDecision:
        """Decide on a request.

        Args:
            target: Path and query of the request.
            host: Host header.
            origin: Origin header; None if absent. Browsers always send it for a web socket.
            cookies: Cookie header.
            is_socket: Whether the request opens a web socket.
        """
        if _host_name(f"//{host}") not in self._hosts:
            return AccessDecision(FORBIDDEN, "this name is not one of the cockpit's")
        if origin is not None and origin != f"http://{host}":
            return AccessDecision(FORBIDDEN, "requested by a page of another site")
        if is_socket and origin is None:
            return AccessDecision(FORBIDDEN, "requested without an Origin header")
        token = parse_qs(target.partition("?")[2]).get("token", [""])[0]
        if not is_socket and self._is_token(token):
            return AccessDecision(OK, cookie=f"{self._cookie}={self.token}; HttpOnly; SameSite=Lax; Path=/")
        if not self._is_token(self._token_of(cookies)):
            return AccessDecision(FORBIDDEN, "open the URL that the terminal prints: it has the token")
        return AccessDecision(OK)

    def _is_token(self, text: str) -> bool:
        return hmac.compare_digest(text.encode(), self.token.encode())

    def _token_of(self, cookies: str) -> str:
        try:
            morsel = SimpleCookie(cookies).get(self._cookie)
        except CookieError:
            return ""
        return morsel.value if morsel is not None else ""


def _host_name(address: str) -> Optional[str]:
    """Return the name in ``//name:port``, or None if the address is malformed."""
    try:
        return urlsplit(address).hostname
    except ValueError:
        return None
