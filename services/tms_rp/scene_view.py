"""What people see of a planner's scene: its bodies as boxes with margins, the areas of records, the way of the tip."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from tms_config.models import MachineModel
from tms_control.links import Array, Links, Matrix, box_place
from tms_machine.values import Value
from tms_reason.reason import Reason
from tms_rp.bodies import Body
from tms_rp.clearance import Clearance
from tms_rp.meshes import Mesh
from tms_rp.reasons import Part, PartOf
from tms_rp.scene import Obstacle, Scene
from tms_rp.trajectory import Trajectory

WAY = 60  # places of the way of a tip
OWN, MACHINE, RECORD = "own", "machine", "record"  # kinds

Point = tuple[float, float, float]


@dataclass(frozen=True)
class Shown:
    """A body: centre in base_link, sides [m], what the planner adds on each side [m], age [s], surface."""

    kind: str
    name: Reason
    place: Matrix
    sides: Point
    margin: float
    age: float = 0.0
    mesh: Mesh | None = None


@dataclass(frozen=True)
class Area:
    """Where a record says that an excavator is to work: centre and sides [m], base_link."""

    record: str
    centre: Point
    sides: Point


def bodies(clearance: Clearance, scene: Scene, pose: Sequence[float]) -> list[Shown]:
    """The machine's own at a pose [rad, all joints], then those of the scene."""
    places = clearance.places(np.array([pose]))[0]
    more: dict[Reason, float] = {Part(link): by for link, by in clearance.more(scene).items()}
    own = [_own(body, place, more.get(body.name, 0.0)) for body, place in zip(clearance.own, places, strict=True)]
    return [*own, *map(_obstacle, scene.obstacles)]


def _own(body: Body, place: Matrix, more: float) -> Shown:
    return Shown(OWN, body.name, place, _point(2 * body.bare), body.padding + more)


def _obstacle(one: Obstacle) -> Shown:
    kind = MACHINE if isinstance(one.name, PartOf) else RECORD
    off = one.mesh.off if one.mesh else 0.0
    sides = np.subtract(one.box.max, one.box.min) - 2 * (one.growth + off)
    return Shown(kind, one.name, one.place @ box_place(one.box), _point(sides), one.growth + off, one.age, one.mesh)


def areas(records: Mapping[str, Mapping[str, Value]]) -> list[Area]:
    """The areas of records (waypoints of type `area` of version 6 of the C++ system, and its `excavatable_points`)."""
    found = []
    for name, values in records.items():
        for waypoint in _documents(values.get("waypoints")):
            data = waypoint.get("data")
            if waypoint.get("type") == "area" and isinstance(data, dict):
                found += _area(name, data)
        for point in _documents(values.get("excavatable_points")):
            found += _area(name, {"size_x": 0.0, "size_y": 0.0, "size_z": 0.0, **point})
    return found


def _documents(value: object) -> Iterable[dict[str, Value]]:
    return [one for one in value if isinstance(one, dict)] if isinstance(value, list) else []


def _area(record: str, told: Mapping[str, Value]) -> list[Area]:
    """One area; none where a number is missing: it is only shown."""
    numbers = [told.get(name) for name in ("x", "y", "z", "size_x", "size_y", "size_z")]
    values = [float(one) for one in numbers if isinstance(one, (int, float))]
    if len(values) < len(numbers) or not np.isfinite(values).all():
        return []
    return [Area(record, _point(values[:3]), _point(values[3:]))]


def way_of_tip(model: MachineModel, made: Trajectory) -> list[Point]:
    """Some places of the tip on a trajectory, in base_link: the origin of the last frame of the machine file."""
    count = len(made.samples)
    chosen = sorted({round(i * (count - 1) / (WAY - 1)) for i in range(WAY)})
    last = list(model.geometry.values())[-1]
    places = Links(model).places(np.array([made.samples[i].positions for i in chosen]))
    return [_point(place @ [*last.xyz, 1.0]) for place in places[last.parent]]


def _point(values: Array | Sequence[float]) -> Point:
    x, y, z = (float(one) for one in values[:3])
    return x, y, z
