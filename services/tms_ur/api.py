"""The HTTP API and the console's files; `/openapi.json` describes the API."""

import json
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from functools import cache
from http import HTTPStatus
from pathlib import Path as File
from typing import TYPE_CHECKING

import anyio
import anyio.to_thread
import structlog
from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse, Response
from fastapi.staticfiles import StaticFiles
from starlette.exceptions import HTTPException
from starlette.middleware.gzip import GZipMiddleware

from tms_config.config import Site
from tms_reason.errors import TmsError
from tms_reason.reason import Reason
from tms_ur import bodies, commands, editor, logs, reading, recordings, sessions, work
from tms_ur.access import Access
from tms_ur.hashing import Hashing
from tms_ur.problems import problem, problems
from tms_ur.reasons import BadRequest, InternalError, MethodNotAllowed, NotFound
from tms_ur.security import SECURITY, SecurityMiddleware

if TYPE_CHECKING:
    from tms_ur.audit import Audit
    from tms_ur.site_client import SiteClient

STATIC = File(__file__).parent / "static"  # the panel, and what the pages share with it
BUILT = File(__file__).parent / "built"  # of console/, by `make setup`
WORKERS = 8  # threads for calls that wait for a module

log = structlog.stdlib.get_logger(__name__)


def create_app(client: "SiteClient", audit: "Audit", site: Site, access: Access) -> FastAPI:
    """The application for one site."""
    app = FastAPI(
        title="ROS2-TMS for Construction, task management", version="0.1.0", lifespan=_lifespan,
        docs_url=None, redoc_url=None,  # these pages load scripts from the internet, and a site may be offline
        openapi_url=None,  # served by _describe
        # nothing leaves the site because of an environment variable
        telemetry={"tracing": False, "metrics": False, "logs": False, "auto_configure": False},
        responses=problems(400, 401, 422),
    )  # fmt: skip
    hashing = Hashing()
    reading.add(app, client, audit, site)
    bodies.add(app, site)
    editor.add(app, client, site)
    recordings.add(app, client, site)
    logs.add(app, client, site)
    work.add(app, client, site)
    commands.add(app, client, audit, site)
    sessions.add(app, access, hashing, audit, secure=site.file.console.tls is not None)
    app.add_exception_handler(TmsError, _tms_error)
    app.add_exception_handler(HTTPException, _http_error)
    app.add_exception_handler(RequestValidationError, _bad_request)
    app.add_exception_handler(500, _bug)
    app.add_middleware(
        SecurityMiddleware,
        bind=site.file.bind,
        access=access,
        hashing=hashing,
        audit=audit,
        names=site.file.console.names,
    )
    _describe(app)
    files = StaticFiles(directory=BUILT, packages=[("tms_ur", STATIC.name)], html=True)
    app.mount("/", GZipMiddleware(files), name="console")
    return app


@asynccontextmanager
async def _lifespan(app: FastAPI) -> AsyncIterator[None]:
    anyio.to_thread.current_default_thread_limiter().total_tokens = WORKERS
    yield


def _describe(app: FastAPI) -> None:
    """Serve `/openapi.json`, which is made once: any client may ask for it, as often as it likes.

    At the first request, in a thread of its own, not in one of those that a press of the stop needs: it takes as long
    as to make all the rest of the application.
    """
    own = anyio.CapacityLimiter(1)

    @cache
    def text() -> str:
        return json.dumps(app.openapi(), ensure_ascii=False, separators=(",", ":"))

    @app.get("/openapi.json", include_in_schema=False)
    async def document() -> Response:
        return Response(await anyio.to_thread.run_sync(text, limiter=own), media_type="application/json")


# errors


def _tms_error(_request: Request, error: Exception) -> JSONResponse:
    assert isinstance(error, TmsError)
    return problem(error)


def _http_error(request: Request, error: Exception) -> JSONResponse:
    assert isinstance(error, HTTPException)
    asked = request.method, request.url.path
    known: dict[int, Reason] = {404: NotFound(*asked), 405: MethodNotAllowed(*asked)}
    reason = known.get(error.status_code) or BadRequest(" ".join(asked), error.detail)
    answer = problem(TmsError(reason), error.status_code)
    answer.headers.update(error.headers or {})
    return answer


def _bad_request(_request: Request, error: Exception) -> JSONResponse:
    assert isinstance(error, RequestValidationError)
    first = error.errors()[0]
    where = ".".join(str(part) for part in first["loc"])
    return problem(TmsError(BadRequest(where, str(first["msg"]))), HTTPStatus.UNPROCESSABLE_ENTITY)


def _bug(_request: Request, error: Exception) -> JSONResponse:
    """Answer for an unexpected exception; the server writes its traceback into the log."""
    answer = problem(TmsError(InternalError(type(error).__name__, "tms:ur")), HTTPStatus.INTERNAL_SERVER_ERROR)
    answer.headers.update(SECURITY)  # this answer does not pass the middleware
    return answer
