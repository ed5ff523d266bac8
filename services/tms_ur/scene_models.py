"""The scene of a planner, as the API shows it: all in base_link of its machine."""

from typing import Protocol

from pydantic import Field
from tms_msg_rp.srv import GetScene

from tms_ur.base_model import Model
from tms_ur.reason_view import ReasonView, of_line

Numbers = list[float]


class _Xyz(Protocol):
    x: float
    y: float
    z: float


class SceneBody(Model):
    """A body: a box, or what its surface lies in."""

    kind: str = Field(description="own, machine or record")
    name: ReasonView | None = Field(description="what it is")
    position: Numbers = Field(description="its centre: x, y, z, m")
    orientation: Numbers = Field(description="quaternion x, y, z, w")
    size: Numbers = Field(description="along its own axes, without margin, m")
    margin: float = Field(description="what the planner adds on each side: padding, growth by age, m")
    age: float = Field(description="since it was told, s; 0 where it is known")
    triangles: int = Field(description="of its surface; 0: it is the box")


class SceneArea(Model):
    """Where a record says that the machine is to work, or may dig."""

    record: str
    centre: Numbers = Field(description="x, y, z, m")
    size: Numbers = Field(description="m; 0: a point")


class Scene(Model):
    """What a planner plans among now."""

    machine: str
    bodies: list[SceneBody]
    areas: list[SceneArea]
    way: list[Numbers] = Field(description="of the tip, as planned last: x, y, z, m")


def scene(machine: str, answer: GetScene.Response) -> Scene:
    """The scene in a planner's answer."""
    return Scene(
        machine=machine,
        bodies=[
            SceneBody(
                kind=one.kind, name=of_line(one.name), position=_xyz(one.pose.position),
                orientation=[*_xyz(one.pose.orientation), round(one.pose.orientation.w, 4)], size=_xyz(one.size),
                margin=round(one.margin, 3), age=round(one.age, 1), triangles=len(one.triangles) // 3,
            )
            for one in answer.bodies
        ],
        areas=[SceneArea(record=one.record, centre=_xyz(one.centre), size=_xyz(one.size)) for one in answer.areas],
        way=[_xyz(place) for place in answer.way],
    )  # fmt: skip


def _xyz(of: _Xyz) -> Numbers:
    return [round(of.x, 4), round(of.y, 4), round(of.z, 4)]
