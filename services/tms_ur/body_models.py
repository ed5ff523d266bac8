"""Machines of the site and their bodies, as the API shows them."""

from typing import Literal

from pydantic import Field

from tms_config.config import Site
from tms_config.models import MachineModel
from tms_shapes.solids import solids
from tms_ur.base_model import Model


class JointOrigin(Model):
    """Where a joint is on its parent link; first turned by `pitch` about y, then by its angle about `axis`."""

    joint: str
    parent: str
    child: str
    xyz: list[float] = Field(description="m")
    pitch: float = Field(description="rad")
    axis: str = Field(description="x, y or z")


class Solid(Model):
    """A part of what a machine looks like: an outline on its link, the same over each span of y."""

    link: str
    role: Literal["track", "body", "arm", "tool"]
    y: list[list[float]] = Field(description="from and to, m")
    outline: list[list[float]] = Field(description="x, z on the link, m")


class SiteMachine(Model):
    """A machine of the site and its body."""

    name: str
    model: str
    kind: str
    joints: list[JointOrigin] = Field(description="parents before children; the first parent is base_link")
    solids: list[Solid] = Field(description="what it looks like, for eyes only")


class SiteInfo(Model):
    """What does not change while the console runs."""

    name: str
    backend: str
    machines: list[SiteMachine]


def site_info(site: Site) -> SiteInfo:
    """The machines of a site's file."""
    machines = [_machine(name, use.model, site.models[use.model]) for name, use in site.file.machines.items()]
    return SiteInfo(name=site.name, backend=site.file.backend, machines=machines)


def _machine(name: str, model: str, told: MachineModel) -> SiteMachine:
    return SiteMachine(
        name=name, model=model, kind=told.kind,
        joints=[JointOrigin(joint=joint, parent=one.parent, child=one.child, xyz=list(one.xyz), pitch=one.pitch,
                            axis=one.axis) for joint, one in told.geometry.items()],
        solids=[Solid(link=one.link, role=one.role, y=[list(span) for span in one.y],
                      outline=[list(at) for at in one.outline]) for one in solids(told)],
    )  # fmt: skip
