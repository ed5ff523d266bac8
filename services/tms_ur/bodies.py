"""Endpoints about the machines of the site and what they look like; every role may call them."""

from fastapi import FastAPI, Response

from tms_config.config import Site
from tms_config.reasons import NoMachine
from tms_reason.errors import TmsError
from tms_ur.body_models import SiteInfo, site_info
from tms_ur.problems import problems
from tms_ur.reading import MachineName

ZIP = "application/zip"


def add(app: FastAPI, site: Site) -> None:
    """Add these endpoints to the application."""
    shown = site_info(site)
    names = tuple(site.file.machines)

    @app.get("/api/site", summary="The site's machines and their bodies")
    async def site_bodies() -> SiteInfo:
        return shown

    @app.get(
        "/api/machines/{name}/urdf",
        summary="A machine as a ROS 2 package in a zip file: URDF and meshes",
        responses=problems(404) | {200: {"content": {ZIP: {}}}},
        response_class=Response,
    )
    def urdf(name: MachineName) -> Response:
        from tms_shapes.package import package  # loads libraries for meshes

        if name not in names:
            raise TmsError(NoMachine(name, names))
        data = package(name, site.model_of(name), site.border(name))
        return Response(data, 200, {"Content-Disposition": f'attachment; filename="{name}_description.zip"'}, ZIP)
