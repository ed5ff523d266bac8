"""Obstacles that people and sensing PCs have told: the records `collision_object...` of a machine.

A record says where a body is in base_link. What it is, its `dimensions` or its `triangles` say, or the machine or model
of the site that it is named after (`collision_object_ic120`).
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, PositiveFloat, ValidationError, model_validator

from tms_config.models import Box, MachineModel
from tms_control.links import Matrix
from tms_machine.geometry import Quaternion, about, is_orientation, length, product, unit, x_axis
from tms_machine.reasons import BadRecord, NoUnitLength
from tms_machine.values import Value
from tms_reason.errors import SubtaskFailed
from tms_reason.reason import Reason
from tms_reason.validation import explain
from tms_rp.meshes import Mesh, cone, cylinder, sphere
from tms_rp.neighbour import Neighbour
from tms_rp.reasons import NoShape, SceneRecordOld, SizesUnfit, Told
from tms_rp.scene import Obstacle

PREFIX = "collision_object"
BOX, SPHERE, CYLINDER, CONE = 1, 2, 3, 4
SIZES = {BOX: 3, SPHERE: 1, CYLINDER: 2, CONE: 2}  # sides; radius; height and radius
SIZE_STEP = 0.1  # m to which dimensions are rounded up, as each new size costs a body for ever


@dataclass(frozen=True)
class SceneRecord:
    """One such record: its values, how old they are and may get [s; 0: any age], and whether sensing updates it.

    `mesh`: what its triangles tell.
    """

    name: str
    values: Mapping[str, Value]
    age: float
    max_age: float
    dynamic: bool
    mesh: Mesh | None = None

    def obstacles(self, models: Mapping[str, MachineModel]) -> list[Obstacle]:
        """What it tells; `models`: by name of machine and of model.

        Raises:
            SubtaskFailed: BadRecord, SceneRecordOld: nobody knows what is there.
        """
        if 0 < self.max_age < self.age:
            raise SubtaskFailed(SceneRecordOld(self.name, self.age))
        try:
            told = _Body.model_validate(self.values)
        except ValidationError as error:
            raise SubtaskFailed(BadRecord(self.name, explain(error))) from None
        turn = told.qx, told.qy, told.qz, told.qw
        if not is_orientation(turn):
            raise self._bad(NoUnitLength(f"{length(turn):.3f}"))
        place = _place((told.x, told.y, told.z), unit(turn))
        mesh = self.mesh
        if mesh is None and told.dimensions is not None:
            sides = tuple(SIZE_STEP * math.ceil(side / SIZE_STEP - 1e-6) for side in told.dimensions)
            if len(sides) != SIZES[told.primitive_type]:
                raise self._bad(SizesUnfit(SIZES[told.primitive_type], len(sides)))
            if told.primitive_type == BOX:
                x, y, z = (side / 2 for side in sides)
                return [Obstacle(Told(self.name), Box(min=(-x, -y, -z), max=(x, y, z)), place, self.age)]
            mesh = _round(told.primitive_type, sides)
        if mesh is not None:
            return [Obstacle(Told(self.name), mesh.box, place, self.age, mesh=mesh)]
        named = self.name.removeprefix(PREFIX).lstrip("s").lstrip("_")
        if named not in models:
            raise self._bad(NoShape(named))
        return Neighbour(named, models[named]).obstacles(place, self.age if self.dynamic else 0.0)

    def _bad(self, problem: Reason) -> SubtaskFailed:
        return SubtaskFailed(BadRecord(self.name, problem))


class _Body(BaseModel):
    """The fields of such a record: place of the centre, or of a machine's base_link [m], its turn, the sizes [m]."""

    model_config = ConfigDict(frozen=True, allow_inf_nan=False)

    x: float
    y: float
    z: float
    qx: float = 0.0
    qy: float = 0.0
    qz: float = 0.0
    qw: float = 1.0
    primitive_type: Literal[1, 2, 3, 4] = 1  # as in shape_msgs/SolidPrimitive
    dimensions: tuple[PositiveFloat, ...] | None = None

    @model_validator(mode="before")
    @classmethod
    def _flat(cls, data: Any) -> Any:
        """Version 6 of the C++ system nests the place: `pose` with `position` and `orientation`."""
        pose = data.get("pose")
        if not isinstance(pose, dict):
            return data
        at, turn = (pose.get(part) for part in ("position", "orientation"))
        named = dict(at) if isinstance(at, dict) else {}
        return {**data, **named, **({f"q{axis}": one for axis, one in turn.items()} if isinstance(turn, dict) else {})}


def _round(kind: int, sizes: Sequence[float]) -> Mesh:
    return sphere(*sizes) if kind == SPHERE else cylinder(*sizes) if kind == CYLINDER else cone(*sizes)


def _place(at: tuple[float, float, float], turn: Quaternion) -> Matrix:
    found = np.eye(4)
    quarter = math.pi / 2
    axes = (turn, product(turn, about("z", quarter)), product(turn, about("y", -quarter)))  # that bring x to x, y, z
    found[:3, :3] = np.transpose([x_axis(one) for one in axes])
    found[:3, 3] = at
    return found
