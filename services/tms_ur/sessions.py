"""Endpoints for logging in and out."""

from typing import TYPE_CHECKING, Literal

from fastapi import FastAPI, Request, Response
from pydantic import Field

from tms_reason.errors import TmsError
from tms_ur.access import Access, Person
from tms_ur.base_model import Model
from tms_ur.command_models import Login, Nothing
from tms_ur.hashing import Hashing
from tms_ur.problems import problems
from tms_ur.reasons import NoUsers
from tms_ur.security import COOKIE, source

if TYPE_CHECKING:
    from tms_ur.audit import Audit


class Session(Model):
    """Who you are to the console."""

    name: str | None = Field(description="null: log in first")
    role: Literal["viewer", "operator", "admin"] | None
    login: bool = Field(description="whether this site has users")


def add(app: FastAPI, access: Access, hashing: Hashing, audit: "Audit", secure: bool) -> None:
    """Add these endpoints to the application; `secure`: browsers send cookies over TLS only."""

    @app.get("/api/session", summary="Who you are to the console")
    async def session(request: Request) -> Session:
        return _session(access, request.state.person)

    @app.post(
        "/api/login",
        summary="Begin a session; the answer sets its cookie",
        responses=problems(403, 409, 411, 413, 415, 429),
    )
    async def login(request: Request, response: Response, wanted: Login) -> Session:
        if not access.asks:
            raise TmsError(NoUsers())
        where = source(request.scope)
        try:
            key, person = await hashing.run(where, lambda: access.login(wanted.name, wanted.password, where))
        except TmsError as error:
            audit.refused(wanted.name, where, "login_refused", error.code)
            raise
        audit.put(person.name, where, "login", "")
        response.set_cookie(COOKIE, key, httponly=True, samesite="strict", secure=secure, path="/")
        return _session(access, person)

    @app.post("/api/logout", summary="End the session", responses=problems(403, 411, 413, 415))
    async def logout(request: Request, response: Response, _: Nothing) -> Session:
        access.logout(request.cookies.get(COOKIE, ""))
        response.delete_cookie(COOKIE, path="/")
        return _session(access, None if access.asks else request.state.person)


def _session(access: Access, person: Person | None) -> Session:
    if person is None:
        return Session(name=None, role=None, login=access.asks)
    return Session(name=person.name, role=person.role, login=access.asks)
