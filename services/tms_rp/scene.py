"""What stands around a machine at one moment, in its base_link: what its planner must keep clear of."""

import math
import zlib
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Protocol

import numpy as np

from tms_config.models import Box
from tms_control.links import Matrix
from tms_reason.reason import Reason
from tms_rp.meshes import Mesh
from tms_rp.reasons import Ground

GROWTH_STEP = 0.25  # m; sizes of grown bodies differ by this much, as each new size costs a body for ever
# Our assumption where the terrain is not known: flat, where the tracks stand. The slab reaches beyond the longest arm.
GROUND = Box(min=(-15.0, -15.0, -3.0), max=(15.0, 15.0, 0.0))


@dataclass(frozen=True)
class Obstacle:
    """A body that stands: its name in reasons, its box, the place of the frame of that box in our base_link.

    `age`: how long ago [s] it was told to be there. `lets`: our link that may be in it. `growth`: m by which the box
    was grown on each side. `mesh`: its surface, where the box is only what it lies in; not grown.
    """

    name: Reason
    box: Box
    place: Matrix
    age: float = 0.0
    lets: str = ""
    growth: float = 0.0
    mesh: Mesh | None = None

    def grown(self, by: float) -> "Obstacle":
        """The same, larger by `by` [m] on each side: as far as it may have moved since it was told."""
        if by <= 0:
            return self
        by = GROWTH_STEP * math.ceil(by / GROWTH_STEP)
        (x0, y0, z0), (x1, y1, z1) = self.box.min, self.box.max
        low, high = (x0 - by, y0 - by, z0 - by), (x1 + by, y1 + by, z1 + by)
        return replace(self, box=Box(min=low, max=high, pitch=self.box.pitch), growth=self.growth + by)


@dataclass(frozen=True)
class Region:
    """A rectangle along the axes of a frame in base_link: along x from `near` to `far`, along y from `right` to `left`.

    All in m. `lets`: the link that may be in the ground there.
    """

    near: float
    far: float
    right: float
    left: float
    lets: str = ""


class Surrounding(Protocol):
    """The ground as it is now (terrain.py)."""

    @property
    def whole(self) -> tuple[Obstacle, ...]:
        """All of it."""

    def obstacles(self, frame: Matrix, regions: Sequence[Region]) -> tuple[Obstacle, ...]:
        """What lies in some regions of a frame (4 x 4, in base_link)."""


@dataclass(frozen=True)
class Scene:
    """All obstacles of one moment; `padding`: m that links keep to them, where it is more than usual.

    `ground`: where somebody tells of it; else it counts as flat.
    """

    obstacles: tuple[Obstacle, ...] = ()
    padding: tuple[tuple[str, float], ...] = ()
    ground: Surrounding | None = field(default=None, compare=False)

    def with_ground(self) -> "Scene":
        """The same with the ground, for ways around something: only the goal itself may lead into the soil."""
        ground = (Obstacle(Ground(), GROUND, np.eye(4)),) if self.ground is None else self.ground.whole
        return replace(self, obstacles=(*self.obstacles, *ground))

    def bare(self) -> "Scene":
        """One without obstacles, on the same ground."""
        return Scene(ground=self.ground)

    def fingerprint(self) -> int:
        """A number that is the same for the same scene."""
        parts = [np.round([*one.box.min, *one.box.max, *one.place.ravel()], 3).tobytes() for one in self.obstacles]
        keys = [0 if one.mesh is None else one.mesh.key for one in self.obstacles]
        more = zlib.crc32(repr((keys, self.padding)).encode()) if any(keys) or self.padding else 0
        return zlib.crc32(b"".join(parts), more)
