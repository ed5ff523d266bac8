"""Machines of the site and their bodies, as the API shows them."""

from pydantic import Field

from tms_config.config import Site
from tms_config.models import MachineModel
from tms_ur.base_model import Model


class Box(Model):
    """Corners of a box."""

    min: list[float] = Field(description="m")
    max: list[float] = Field(description="m")


class Link(Model):
    """A joint of an arm, as its side view needs it."""

    joint: str
    x: float = Field(description="m, on the parent link")
    z: float = Field(description="m, on the parent link")
    pitch: float = Field(description="rad, at joint angle 0")


class JointOrigin(Model):
    """Where a joint is on its parent link; first turned by `pitch` about y, then by its angle about `axis`."""

    joint: str
    parent: str
    child: str
    xyz: list[float] = Field(description="m")
    pitch: float = Field(description="rad")
    axis: str = Field(description="x, y or z")


class LinkBox(Box):
    """What a link's body lies in, in the frame of the link turned about y by `pitch`."""

    link: str
    pitch: float = Field(description="rad")


class BucketShape(Model):
    """The inside of a bucket, the same over its width."""

    link: str
    section: list[list[float]] = Field(description="x, z on its link, from the rear lip to the cutting edge, m")
    width: float = Field(description="m")


class VesselShape(Box):
    """The inside of a carrier's vessel, on its link."""

    link: str


class BladeShape(Model):
    """The lower edge of a blade."""

    link: str
    edge: list[float] = Field(description="x, z on its link, m")
    width: float = Field(description="m")


class TracksShape(Model):
    """Where two tracks touch the ground, in base_link."""

    rear: float = Field(description="m, x")
    front: float = Field(description="m, x")
    gauge: float = Field(description="m from middle to middle")
    width: float = Field(description="m, of one")


class SiteMachine(Model):
    """A machine of the site and its body."""

    name: str
    model: str
    kind: str
    footprint: list[Box] = Field(description="in its base frame")
    arm: list[Link] = Field(description="from the turning body to the tool, empty if it has no arm")
    joints: list[JointOrigin] = Field(description="parents before children; the first parent is base_link")
    bodies: list[LinkBox]
    bucket: BucketShape | None
    vessel: VesselShape | None
    blade: BladeShape | None
    tracks: TracksShape | None


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
        name=name, model=model, kind=told.kind, arm=_arm(told),
        footprint=[Box(min=list(box.min), max=list(box.max)) for box in told.footprint.values()],
        joints=[JointOrigin(joint=joint, parent=one.parent, child=one.child, xyz=list(one.xyz), pitch=one.pitch,
                            axis=one.axis) for joint, one in told.geometry.items()],
        bodies=[LinkBox(link=link, min=list(box.min), max=list(box.max), pitch=box.pitch)
                for link, box in told.shapes.items()],
        bucket=told.bucket and BucketShape(
            link=told.bucket.link, section=[list(at) for at in told.bucket.section], width=told.bucket.width),
        vessel=told.vessel and VesselShape(
            link=told.vessel.link, min=list(told.vessel.min), max=list(told.vessel.max)),
        blade=told.blade and BladeShape(link=told.blade.link, edge=list(told.blade.edge), width=told.blade.width),
        tracks=told.tracks and TracksShape(
            rear=told.tracks.rear, front=told.tracks.front, gauge=told.tracks.gauge, width=told.tracks.width),
    )  # fmt: skip


def _arm(model: MachineModel) -> list[Link]:
    """The joints about y, from the body outwards: those that move in a side view."""
    return [
        Link(joint=name, x=origin.xyz[0], z=origin.xyz[2], pitch=origin.pitch)
        for name, origin in model.geometry.items()
        if (origin.axis == "y" and origin.parent != "base_link") or name == "bucket_end_joint"
    ]
