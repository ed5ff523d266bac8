"""Endpoints about what machines have moved; every role may call them."""

from datetime import date
from typing import TYPE_CHECKING, Annotated

from fastapi import FastAPI, Query

from tms_config.clock import utc_now
from tms_config.config import Site
from tms_ur.problems import problems
from tms_ur.work_models import Work, WorkPlan

if TYPE_CHECKING:
    from tms_ur.site_client import SiteClient

FIRST, LAST = date(1970, 1, 2), date(2100, 1, 1)


def add(app: FastAPI, client: "SiteClient", site: Site) -> None:
    """Add these endpoints to the application."""
    told = (site.file.ground or {}).get("plan")  # tms:ground checks it
    plan = WorkPlan.model_validate(told) if told else None

    @app.get("/api/work", summary="What machines have moved on a day, in the site's time", responses=problems(503))
    def work(day: Annotated[date | None, Query(ge=FIRST, le=LAST, description="none: today")] = None) -> Work:
        return client.work(day or utc_now().astimezone().date(), plan)
