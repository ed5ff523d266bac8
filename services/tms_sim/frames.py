"""The link frames of a machine, from its place, its joint origins and its joint positions. Pure logic."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

from tms_config.models import Border, MachineModel
from tms_machine.frames import MAP

Quaternion = tuple[float, float, float, float]  # x, y, z, w


class Frame(NamedTuple):
    """One link in the frame of its parent: position [m] and orientation."""

    parent: str
    child: str
    xyz: tuple[float, float, float]
    turn: Quaternion


@dataclass(frozen=True)
class Chain:
    """All frames of one machine, the first being its base in the map."""

    model: MachineModel
    border: Border  # with the machine's name filled in

    def frames(self, place: tuple[float, float, float], positions: Mapping[str, float]) -> list[Frame]:
        """Frames for a place (x m, y m, yaw rad) and joint positions [rad]; joints left out are at 0."""
        x, y, yaw = place
        prefix = self.border.frame_prefix
        found = [Frame(MAP, self.border.base_frame, (x, y, 0.0), about("z", yaw))]
        for name, origin in self.model.geometry.items():
            turn = _times(about("y", origin.pitch), about(origin.axis, positions.get(name, 0.0)))
            found.append(Frame(prefix + origin.parent, prefix + origin.child, origin.xyz, turn))
        return found


def about(axis: str, angle: float) -> Quaternion:
    """The turn by an angle [rad] about one axis."""
    s, c = math.sin(angle / 2), math.cos(angle / 2)
    return (s * (axis == "x"), s * (axis == "y"), s * (axis == "z"), c)


def _times(a: Quaternion, b: Quaternion) -> Quaternion:
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )
