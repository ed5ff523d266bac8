"""How the API tells what went wrong, and who may ask for what."""

from collections.abc import Callable, Coroutine
from typing import Annotated, Any

from fastapi import Depends, Request
from fastapi.responses import JSONResponse

from tms_reason.errors import TmsError
from tms_ur.access import Person, Role
from tms_ur.models import Problem

TEXTS = {
    400: "the request cannot be read", 401: "log in first", 403: "you may not do this",
    404: "there is no such thing", 409: "refused; the message says why", 411: "no length",
    413: "too large", 415: "not JSON",
    422: "a value is wrong", 429: "too many passwords", 503: "a module of the site is away or does not answer",
}  # fmt: skip


def problems(*statuses: int) -> dict[int | str, dict[str, Any]]:
    """The `responses` of an endpoint."""
    return {status: {"model": Problem, "description": TEXTS[status]} for status in statuses}


def problem(status: int, code: str, message: str) -> JSONResponse:
    return JSONResponse({"code": code, "message": message}, status)


def _needs(role: Role) -> Any:
    """The person who asks, who must have at least this role."""

    async def check(request: Request) -> Person:
        person: Person | None = request.state.person
        if person is None:
            raise TmsError("log in first", "LOGIN")
        if not person.may(role):
            raise TmsError(f"this needs the role {role}, {person.name} is {person.role}", "ROLE")
        return person

    wanted: Callable[[Request], Coroutine[Any, Any, Person]] = check
    return Depends(wanted)


Viewer = Annotated[Person, _needs("viewer")]
Operator = Annotated[Person, _needs("operator")]
Admin = Annotated[Person, _needs("admin")]
