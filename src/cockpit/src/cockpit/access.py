"""Who may see the page: whoever holds the token, from a page that this server itself has sent."""

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
    """``status``: 200, let it pass, or come again with ``cookie`` if there is one; 403, and why."""

    status: int
    reason: str = ""
    cookie: str = ""


class AccessPolicy:
    """Judges requests by token, cookie, Host and Origin.

    The token is in the URL that the terminal prints; the first request turns it into a cookie and is sent on
    to a URL without it. A page of another site that has the name of its own host point here (DNS rebinding)
    is known by its Host, one that calls this server by its Origin.
    """

    def __init__(self, port: int, hosts: Tuple[str, ...] = LOOPBACK, token: Optional[str] = None):
        """``hosts``: names and addresses, beside the loopback's, that browsers may know this machine by."""
        self.token = token or secrets.token_urlsafe(24)
        self._hosts = {*LOOPBACK, *hosts}
        # Cookies know no ports: two cockpits of one machine must not share one.
        self._cookie = f"cockpit_{port}"

    def judge(
        self, target: str, host: str, origin: Optional[str], cookies: str, is_socket: bool
    ) -> AccessDecision:
        """``target``: path and query; ``origin``: None if there is none, which no browser's socket lacks."""
        if _host_name(f"//{host}") not in self._hosts:
            return AccessDecision(FORBIDDEN, "this name is not one of the cockpit's")
        if origin is not None and origin != f"http://{host}":
            return AccessDecision(FORBIDDEN, "asked for by a page of another site")
        if is_socket and origin is None:
            return AccessDecision(FORBIDDEN, "asked for by no page")
        told = parse_qs(target.partition("?")[2]).get("token", [""])[0]
        if not is_socket and self._is_token(told):
            return AccessDecision(OK, cookie=f"{self._cookie}={self.token}; HttpOnly; SameSite=Lax; Path=/")
        if not self._is_token(self._kept(cookies)):
            return AccessDecision(FORBIDDEN, "open the URL that the terminal prints: it has the token")
        return AccessDecision(OK)

    def _is_token(self, text: str) -> bool:
        return hmac.compare_digest(text.encode(), self.token.encode())

    def _kept(self, cookies: str) -> str:
        try:
            morsel = SimpleCookie(cookies).get(self._cookie)
        except CookieError:
            return ""
        return morsel.value if morsel is not None else ""


def _host_name(address: str) -> Optional[str]:
    """The name in ``//name:port``; None if it is none."""
    try:
        return urlsplit(address).hostname
    except ValueError:
        return None
