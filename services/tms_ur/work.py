"""Endpoints about what machines have moved; every role may call them."""

from datetime import date
from typing import TYPE_CHECKING, Annotated, Literal

import anyio
import anyio.to_thread
from fastapi import FastAPI, Query, Response

from tms_config.clock import utc_now
from tms_config.config import Site
from tms_ur.problems import problems
from tms_ur.work_models import Work
from tms_work.plan import Plan

if TYPE_CHECKING:
    from tms_ur.site_client import SiteClient

FIRST, LAST = date(1970, 1, 2), date(2100, 1, 1)
TYPES = {"html": "text/html; charset=utf-8", "pdf": "application/pdf"}
Day = Annotated[date | None, Query(ge=FIRST, le=LAST, description="none: today")]


def add(app: FastAPI, client: "SiteClient", site: Site) -> None:
    """Add these endpoints to the application."""
    told = (site.file.ground or {}).get("plan")  # tms:ground checks it
    plan = Plan.model_validate(told) if told else None

    @app.get("/api/work", summary="What machines have moved on a day, in the site's time", responses=problems(503))
    def work(day: Day = None) -> Work:
        return client.work(day or _today(), plan)

    one_at_a_time = anyio.CapacityLimiter(1)  # of its own: a report takes seconds, and a stop needs the other threads

    @app.get(
        "/api/work/report",
        summary="The daily report as a file",
        responses=problems(503) | {200: {"content": {kind: {} for kind in TYPES.values()}}},
        response_class=Response,
    )
    async def report(
        day: Day = None, form: Literal["html", "pdf"] = "pdf", language: Literal["en", "ja"] = "en"
    ) -> Response:
        from tms_ur.report_client import Wanted  # libraries that are loaded for a report only

        wanted = Wanted(site.name, day or _today(), plan, form, language)
        data = await anyio.to_thread.run_sync(client.report, wanted, limiter=one_at_a_time)
        name = f'attachment; filename="daily-report-{wanted.day.isoformat()}.{form}"'
        return Response(data, 200, {"Content-Disposition": name}, TYPES[form])


def _today() -> date:
    """In the time of this PC."""
    return utc_now().astimezone().date()
