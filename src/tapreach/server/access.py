"""Who may talk to the server at all: Host, Origin and, on a network, the pairing token."""

import hmac
import ipaddress
from collections.abc import Iterable
from http.cookies import CookieError, SimpleCookie
from urllib.parse import parse_qs, urlsplit

from starlette.datastructures import Headers
from starlette.responses import PlainTextResponse, RedirectResponse, Response
from starlette.types import ASGIApp, Receive, Scope, Send

LOOPBACK_NAMES = frozenset({"localhost", "127.0.0.1", "::1"})
COOKIE = "tapreach_token"


class AccessPolicy:
    """Decides from the headers alone.

    Without a token only loopback names are served. With a token, which a network needs, numeric addresses
    and the given host names are served too. A numeric Host cannot come from DNS rebinding; a name that is not
    ours can. A browser's Origin must be the very host it talks to; programs that send none are let through.
    """

    def __init__(self, token: str | None = None, host_names: Iterable[str] = ()) -> None:
        self._token = token
        self._names = LOOPBACK_NAMES | {name.lower() for name in host_names}

    def host_refusal(self, host: str | None) -> str:
        """Return why this Host header is refused, or ''."""
        name = _name_of(host or "")
        if name in self._names or (self._token is not None and _is_address(name)):
            return ""
        return f"host {host!r} is not served; open {', '.join(sorted(self._names))}"

    def origin_refusal(self, origin: str | None, host: str | None) -> str:
        """Return why this Origin header is refused, or ''."""
        if origin is None or origin.lower() == f"http://{host}".lower():
            return ""
        return f"origin {origin!r} is not this page ('http://{host}')"

    def token_refusal(self, cookie: str | None, query_token: str | None) -> str:
        """Return why the pairing is refused, or ''. Compares in constant time."""
        if self._token is None:
            return ""
        shown = [value for value in (query_token, _cookie_token(cookie)) if value]
        if any(self.is_token(value) for value in shown):
            return ""
        return "pairing token wrong" if shown else "pairing token missing: open the address that was printed"

    def is_token(self, value: str | None) -> bool:
        """Tell whether this is the pairing token."""
        if self._token is None or value is None:
            return False
        return hmac.compare_digest(value.encode(), self._token.encode())


class AccessCheck:
    """ASGI middleware: every request and every socket passes the policy or is refused with a sentence."""

    def __init__(self, app: ASGIApp, policy: AccessPolicy) -> None:
        self._app = app
        self._policy = policy

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """See ASGI."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        response = self._refusal(scope) or self._pairing(scope)
        if response is None:
            await self._app(scope, receive, send)
        elif scope["type"] == "http":
            await response(scope, receive, send)
        else:
            # Before it is accepted, closing a socket is answered with 403.
            await receive()
            await send({"type": "websocket.close", "code": 1008, "reason": "refused"})

    def _refusal(self, scope: Scope) -> Response | None:
        headers = Headers(scope=scope)
        host = headers.get("host")
        reason = self._policy.host_refusal(host)
        if reason:
            return PlainTextResponse(reason + "\n", status_code=421)
        reason = self._policy.origin_refusal(headers.get("origin"), host)
        if reason:
            return PlainTextResponse(reason + "\n", status_code=403)
        reason = self._policy.token_refusal(headers.get("cookie"), _query_token(scope))
        return PlainTextResponse(reason + "\n", status_code=401) if reason else None

    def _pairing(self, scope: Scope) -> Response | None:
        """Turn the token of the printed address into a cookie, and out of the address bar."""
        token = _query_token(scope)
        if scope["type"] != "http" or scope["path"] != "/" or not self._policy.is_token(token):
            return None
        response = RedirectResponse("/", status_code=303, headers={"Cache-Control": "no-store"})
        response.set_cookie(COOKIE, token or "", httponly=True, samesite="strict", path="/")
        return response


def _name_of(host: str) -> str:
    try:
        return (urlsplit(f"//{host}").hostname or "").lower()
    except ValueError:
        return ""


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


def _query_token(scope: Scope) -> str | None:
    values = parse_qs(scope["query_string"].decode("latin-1")).get("token")
    return values[0] if values else None


def _cookie_token(cookie: str | None) -> str | None:
    try:
        morsel = SimpleCookie(cookie or "").get(COOKIE)
    except CookieError:
        return None
    return morsel.value if morsel else None
