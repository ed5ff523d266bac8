"""Endpoints that the editor of tasks draws with; checking and storing are those of any file."""

from typing import TYPE_CHECKING, Annotated

from fastapi import FastAPI, Path

from tms_config.config import Site
from tms_reason.names import Name
from tms_ur.editor_models import Palette, TemplateText, Worker
from tms_ur.problems import problems

if TYPE_CHECKING:
    from tms_ur.site_client import SiteClient


def add(app: FastAPI, client: "SiteClient", site: Site) -> None:
    """Add these endpoints to the application."""
    machines = [
        Worker(name=name, model=use.model, subtasks=list(site.model_of(name).subtasks))
        for name, use in site.file.machines.items()
    ]

    @app.get("/api/palette", summary="What a task can be made of: nodes, machines, their subtasks")
    async def palette() -> Palette:
        return Palette(xml=client.palette, machines=machines)

    @app.get("/api/templates/{name}", summary="The tree of a template", responses=problems(404, 503))
    def template(name: Annotated[Name, Path()]) -> TemplateText:
        return TemplateText(xml=client.template(name))
