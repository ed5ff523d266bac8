"""The ground round the place where a tool digs: there only the tool may be in it, elsewhere nothing."""

import math
from dataclasses import dataclass, replace

from tms_config.models import Box
from tms_control.links import Matrix, placed
from tms_rp.reasons import Ground
from tms_rp.scene import Obstacle, Region, Scene

AROUND, DEEP = 15.0, 3.0  # m, as far as the slab of the scene's ground reaches
LONGEST = 6.0  # m, of a trench
STEP = 0.2  # m


@dataclass(frozen=True)
class Trench:
    """Where a tool digs: in the plane of its arm.

    That plane goes from a point (x, y) [m, base_link] in a direction `yaw` [rad], and is `width` [m] wide. The tool may
    be in the ground from `near` to `far` [m, from that point]; there the ground is at `top` [m]. `tool`: its link.
    """

    x: float
    y: float
    yaw: float
    width: float
    near: float
    far: float
    top: float
    tool: str

    def around(self, scene: Scene) -> Scene:
        """A scene with the ground and the trench in it; each trench of a machine is made of the same bodies."""
        if scene.ground is not None:
            found = scene.ground.obstacles(placed(self.x, self.y, self.yaw), self._regions())
            return replace(scene, obstacles=(*scene.obstacles, *found))
        side, beyond, near = self.width / 2, AROUND, max(self.near, self.far - LONGEST)
        walls = [
            (0.0, 0.0, Box(min=(-beyond, side, -DEEP), max=(beyond, beyond, 0.0))),
            (0.0, 0.0, Box(min=(-beyond, -beyond, -DEEP), max=(beyond, -side, 0.0))),
            (near, 0.0, Box(min=(-beyond, -side, -DEEP), max=(0.0, side, 0.0))),
            (self.far, 0.0, Box(min=(0.0, -side, -DEEP), max=(beyond, side, 0.0))),
        ]
        soil = Box(min=(-LONGEST, -side, -DEEP), max=(0.0, side, 0.0))
        flat = [Obstacle(Ground(), box, self._place(out, up)) for out, up, box in walls]
        flat.append(Obstacle(Ground(), soil, self._place(self.far, self.top), lets=self.tool))
        return replace(scene, obstacles=(*scene.obstacles, *flat))

    def _regions(self) -> list[Region]:
        """The ground in the trench, and that around it; lengths are whole steps, so that the bodies are few."""
        side, end = self.width / 2, AROUND
        near = max(-end, STEP * math.floor(max(self.near, self.far - LONGEST) / STEP))
        far = min(end, STEP * math.ceil(self.far / STEP))
        found = [
            Region(-end, end, side, end),
            Region(-end, end, -end, -side),
            Region(near, far, -side, side, self.tool),
        ]
        found += [Region(-end, near, -side, side)] * (near > -end)
        return found + [Region(far, end, -side, side)] * (far < end)

    def _place(self, out: float, up: float) -> Matrix:
        found = placed(self.x, self.y, self.yaw)
        found[:3, 3] += found[:3, 0] * out
        found[2, 3] = up
        return found
