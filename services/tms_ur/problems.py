"""The API's answers for errors, and the roles that its endpoints need."""

from collections.abc import Callable, Coroutine
from http import HTTPStatus
from typing import Annotated, Any

from fastapi import Depends, Request
from fastapi.responses import JSONResponse

from tms_reason.errors import TmsError
from tms_ur.access import Person, RoleName
from tms_ur.reason_view import ReasonView, of_error
from tms_ur.reasons import Login, NobodyLoggedIn, Role
from tms_ur.statuses import STATUS, retry_after

TEXTS = {
    400: "the request cannot be read", 401: "log in first", 403: "you may not do this",
    404: "there is no such thing", 409: "refused; the message says why", 411: "no length",
    413: "too large", 415: "not JSON",
    422: "a value is wrong", 429: "too many passwords", 503: "a module of the site is away or does not answer",
}  # fmt: skip


def problems(*statuses: int) -> dict[int | str, dict[str, Any]]:
    """The error `responses` of an endpoint for OpenAPI; a `model` would make a validator for each of some 250."""
    content = {"application/json": {"schema": {"$ref": f"#/components/schemas/{ReasonView.__name__}"}}}
    return {status: {"content": content, "description": TEXTS[status]} for status in statuses}


def problem(error: TmsError, status: int | None = None) -> JSONResponse:
    """The answer for an error; `status` where it does not follow from the code."""
    shown = of_error(error).model_dump(mode="json")
    found = STATUS.get(error.code, HTTPStatus.CONFLICT) if status is None else status
    return JSONResponse(shown, found, retry_after(error.reason))


def _needs(role: RoleName) -> Any:
    """A dependency that gives the person of a request and refuses one without at least this role."""

    async def check(request: Request) -> Person:
        person: Person | None = request.state.person
        if person is None:
            raise TmsError(Login(NobodyLoggedIn()))
        if not person.may(role):
            raise TmsError(Role(role, person.name, person.role))
        return person

    wanted: Callable[[Request], Coroutine[Any, Any, Person]] = check
    return Depends(wanted)


Viewer = Annotated[Person, _needs("viewer")]
Operator = Annotated[Person, _needs("operator")]
Admin = Annotated[Person, _needs("admin")]
