"""The link frames of a machine, from its place, its joint origins and its joint positions. Pure logic."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

from tms_config.models import Border, MachineModel
from tms_machine.frames import MAP
from tms_machine.geometry import Quaternion, about, product
from tms_sim.soil import LEVEL, Stance, turn_of


class LinkTransform(NamedTuple):
    """One link in the frame of its parent: position [m] and orientation."""

    parent: str
    child: str
    xyz: tuple[float, float, float]
    turn: Quaternion


@dataclass(frozen=True)
class Chain:
    """All frames of one machine, the first being its base in the map."""

    model: MachineModel
    border: Border  # its names hold the machine's name already

    def frames(
        self, place: tuple[float, float, float], positions: Mapping[str, float], stands: Stance = LEVEL
    ) -> list[LinkTransform]:
        """Frames for a place (x m, y m, yaw rad) and joint positions [rad]; joints left out are at 0."""
        x, y, yaw = place
        prefix = self.border.frame_prefix
        found = [LinkTransform(MAP, self.border.base_frame, (x, y, stands.height), turn_of(yaw, stands))]
        for name, origin in self.model.geometry.items():
            turn = product(about("y", origin.pitch), about(origin.axis, positions.get(name, 0.0)))
            found.append(LinkTransform(prefix + origin.parent, prefix + origin.child, origin.xyz, turn))
        return found
