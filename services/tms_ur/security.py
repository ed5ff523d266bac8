"""Checks of every request: host name, person, form of a command; and the security headers of every answer.

The browser must not let foreign pages in: only requests to our own names are answered (a foreign name that resolves
to this PC is DNS rebinding), and commands are JSON (which a foreign page cannot send without asking first) from our
own pages or from no page at all. Without users, commands are accepted only where only this PC can connect.
"""

import ipaddress
from dataclasses import dataclass
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.requests import HTTPConnection
from starlette.responses import JSONResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from tms_reason.errors import TmsError
from tms_reason.reason import Reason
from tms_ur.access import Access, Person
from tms_ur.callers import caller
from tms_ur.hashing import Hashing
from tms_ur.reason_view import view
from tms_ur.reasons import (
    Crowded,
    ForeignHost,
    ForeignOrigin,
    Login,
    NoAccessControl,
    NobodyLoggedIn,
    NoLength,
    NotJson,
    RequestTooLarge,
)
from tms_ur.room import Room, is_stop
from tms_ur.statuses import STATUS, retry_after

if TYPE_CHECKING:
    from tms_ur.audit import Audit

LOCAL_NAMES = frozenset({"localhost", "127.0.0.1", "::1"})
MAX_BODY = 16 * 1024  # bytes of a command ...
MAX_TASK = 6 * 2**20  # ... and of one that carries a tree
OPEN = frozenset({"/api/session", "/api/login"})  # paths that need no login
COOKIE = "tms_session"
LOCAL = Person("local", "admin")  # without users: any person at this PC
GUEST = Person("guest", "viewer")  # without users, where other PCs can connect

SECURITY = {
    "Content-Security-Policy": "default-src 'self'; object-src 'none'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'",
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
}


@dataclass(frozen=True)
class Refusal:
    """Why a request is not let through."""

    status: int
    reason: Reason
    headers: dict[str, str] | None = None


BUSY = Refusal(
    503, Crowded(),
    {"Connection": "close", "Retry-After": "2"},  # further requests on the same connection are dropped, too
)  # fmt: skip
NOBODY = Refusal(401, Login(NobodyLoggedIn()))


class SecurityMiddleware:
    """ASGI middleware around the whole application."""

    def __init__(
        self, app: ASGIApp, bind: str, access: Access, hashing: Hashing, audit: "Audit", names: tuple[str, ...] = ()
    ) -> None:
        self._app, self._bind, self._access, self._hashing, self._audit = app, bind, access, hashing, audit
        self._names = LOCAL_NAMES | {bind.lower(), *(name.lower() for name in names)}
        self._loopback = is_loopback(bind)
        self._room = Room()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return

        async def secured(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(raw=message["headers"])
                headers.update(SECURITY)
                headers["Cache-Control"] = "no-store" if scope["path"].startswith("/api/") else "no-cache"
            await send(message)

        who = caller(source(scope))
        if is_stop(scope):
            await self._answer(scope, receive, secured)
        elif self._room.enter(who):
            try:
                await self._answer(scope, receive, secured)
            finally:
                self._room.leave(who)
        else:
            await _refuse(BUSY, scope, receive, secured)

    async def _answer(self, scope: Scope, receive: Receive, send: Send) -> None:
        refusal = self._refusal(scope) or await self._stranger(scope)
        if refusal is None:
            await self._app(scope, receive, send)
            return
        if refusal is not NOBODY or scope["method"] == "POST":  # a page goes on asking when its session is over
            self._audit.refused("-", source(scope), "refused", refusal.reason.code)
        await _refuse(refusal, scope, receive, send)

    def _refusal(self, scope: Scope) -> Refusal | None:
        headers = Headers(scope=scope)
        host = headers.get("host", "")
        if not self._ours(host):
            return Refusal(400, ForeignHost(host, self._bind))
        if scope["method"] != "POST":  # only POST changes anything; the router refuses other methods
            return None
        return self._command_refusal(headers, host, MAX_TASK if scope["path"].startswith("/api/tasks") else MAX_BODY)

    async def _stranger(self, scope: Scope) -> Refusal | None:
        """Find the person of the request for the endpoints; the whole API except the login needs one."""
        try:
            person = await self._person(scope)
        except TmsError as error:
            return Refusal(STATUS[error.code], error.reason, retry_after(error.reason))
        scope.setdefault("state", {})["person"] = person
        if person is None and scope["path"].startswith("/api/") and scope["path"] not in OPEN:
            return NOBODY
        return None

    async def _person(self, scope: Scope) -> Person | None:
        if not self._access.asks:
            return LOCAL if self._loopback else GUEST
        headers, where = Headers(scope=scope), source(scope)
        kind, _, token = headers.get("authorization", "").partition(" ")
        if kind.lower() == "bearer":
            known = self._access.known_token(token)
            return known or await self._hashing.run(where, lambda: self._access.token(token, where), is_stop(scope))
        key = HTTPConnection(scope).cookies.get(COOKIE, "")
        return self._access.session(key) if key else None

    def _command_refusal(self, headers: Headers, host: str, most: int) -> Refusal | None:
        if not self._loopback and not self._access.asks:
            return Refusal(403, NoAccessControl(self._bind))
        origin = headers.get("origin")
        if origin is not None and _split(origin) != host.lower():
            return Refusal(403, ForeignOrigin(origin))
        if headers.get("content-type", "").partition(";")[0].strip().lower() != "application/json":
            return Refusal(415, NotJson())
        length = headers.get("content-length", "0")
        if "transfer-encoding" in headers or not length.isdigit():  # chunks are valid, whatever length the headers give
            return Refusal(411, NoLength())
        if int(length) > most:
            return Refusal(413, RequestTooLarge(most))
        return None

    def _ours(self, host: str) -> bool:
        name = _name(host)
        if name in self._names:
            return True
        # Bound to all addresses: accept numeric addresses, which a foreign name server cannot forge.
        return self._bind in ("0.0.0.0", "::") and name is not None and _is_address(name)


async def _refuse(refusal: Refusal, scope: Scope, receive: Receive, send: Send) -> None:
    body = view(refusal.reason).model_dump(mode="json")
    await JSONResponse(body, refusal.status, refusal.headers)(scope, receive, send)


def source(scope: Scope) -> str:
    """Address of the client."""
    client = scope.get("client")
    return str(client[0]) if client else "-"


def is_loopback(bind: str) -> bool:
    """Whether only this PC can connect to `bind`."""
    return bind == "localhost" or (_is_address(bind) and ipaddress.ip_address(bind).is_loopback)


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


def _name(host: str) -> str | None:
    """The name in a Host header, None if it is malformed."""
    try:
        return urlsplit(f"//{host}").hostname
    except ValueError:
        return None


def _split(origin: str) -> str | None:
    """host:port of an http origin; None for `null` and for other schemes."""
    scheme, _, netloc = origin.lower().partition("://")
    return netloc if scheme in ("http", "https") and netloc else None
