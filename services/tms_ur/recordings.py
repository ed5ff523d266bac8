"""Endpoints of the recordings of runs; every role may call them."""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, Literal

from fastapi import FastAPI, Query, Response
from fastapi.responses import StreamingResponse

from tms_config.config import Site
from tms_ur.body_models import site_info
from tms_ur.problems import problems
from tms_ur.reading import RunId, all_events
from tms_ur.recording_client import LAST_SECOND, Asked
from tms_ur.recording_models import Recording

if TYPE_CHECKING:
    from tms_ur.site_client import SiteClient

TYPES = {"csv": "text/csv; charset=utf-8", "mcap": "application/octet-stream"}
MACHINE = r"^([a-z][a-z0-9_]{0,63})?$"
RUN = r"^[0-9A-Za-z_-]{0,64}$"
MOST = 20_000  # points of a series


def add(app: FastAPI, client: "SiteClient", site: Site) -> None:
    """Add these endpoints to the application."""
    bodies = site_info(site).machines

    @app.get("/api/recordings", summary="Joints, poses and loads of machines while runs were active",
             responses=problems(404, 409, 503))  # fmt: skip
    def recordings(
        run_id: Annotated[str, Query(pattern=RUN, description="of this run; empty: from begin to end")] = "",
        begin: Annotated[float, Query(ge=0, le=LAST_SECOND, description="s since 1970")] = 0.0,
        end: Annotated[float, Query(ge=0, le=LAST_SECOND, description="s since 1970; 0: up to now")] = 0.0,
        machine: Annotated[str, Query(pattern=MACHINE, description="empty: all")] = "",
        points: Annotated[
            int, Query(ge=2, le=MOST, description="of a series; of more, some at equal distances")
        ] = 2000,
    ) -> Recording:
        return client.recording(Asked(run_id, begin, end, machine, points))

    @app.get(
        "/api/recordings/{run_id}/export",
        summary="The recording of a run as a table, or with its journal as MCAP for Foxglove and rosbag2",
        responses=problems(404, 409, 503) | {200: {"content": {kind: {} for kind in TYPES.values()}}},
        response_class=Response,
    )
    def export(run_id: RunId, form: Literal["csv", "mcap"] = "mcap") -> StreamingResponse:
        from tms_ur.recording_export import Export, as_csv, as_mcap  # libraries that are loaded for an export only

        found = Export(client.recording, run_id)
        body: Iterator[bytes] = as_csv(found) if form == "csv" else as_mcap(found, all_events(client, run_id), bodies)
        name = f'attachment; filename="{run_id}-motion.{form}"'
        return StreamingResponse(body, 200, {"Content-Disposition": name}, TYPES[form])
