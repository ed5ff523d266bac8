"""Whether a machine would touch itself or something in a scene: the one collision checker of the planner."""

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from tms_config.models import Box, MachineModel
from tms_control.links import Array, Links, Matrix, reaches
from tms_reason.reason import Reason
from tms_rp.bodies import Body, Surface, Surfaces
from tms_rp.reasons import Part
from tms_rp.scene import Obstacle, Scene
from tms_rp.trajectory import Trajectory
from tms_rp.view import View

PADDING = 0.1  # m, usual
# m that no point of the machine moves further between two checked poses: it is never further than PADDING from one.
TRAVEL = 2 * PADDING


class Clearance:
    """Looks at scenes for one machine; `padding`: m around the bodies that the arm moves."""

    def __init__(self, model: MachineModel, padding: float = PADDING) -> None:
        self._links = links = Links(model)
        self._reach = np.array(list(reaches(model).values()))
        self._padding = padding
        self._own = {
            link: Body(Part(link), box, padding if link in links.moved else 0.0) for link, box in model.shapes.items()
        }
        # Bodies in scenes, as many as the site has: by name, box, and key of the surface.
        self._known: dict[tuple[Reason, Box, int | None], Body] = {}
        self._surfaces, self._shown = Surfaces(), dict[Reason, int | None]()
        self._looking = threading.Lock()  # guards the places of all bodies
        # Neighbours along the arm, and links of the arm among each other, are kept apart by the joint limits.
        self._pairs = [
            (i, j) for (i, a), (j, b) in combinations(enumerate(self._own), 2)
            if links.parent.get(a) != b and links.parent.get(b) != a and not {a, b} <= links.moved
        ]  # fmt: skip
        self._moved = [(i, link) for i, link in enumerate(self._own) if link in links.moved]

    @contextmanager
    def looking(self, scene: Scene) -> Iterator[View]:
        """A look at a scene; others wait meanwhile."""
        with self._looking:
            yield View(self, scene)

    def check(self, made: Trajectory, scene: Scene) -> None:
        """Check a whole trajectory, as View.check."""
        with self.looking(scene) as view:
            view.check(made)

    @property
    def own(self) -> list[Body]:
        """The bodies of the machine itself."""
        return list(self._own.values())

    def bodies(self, scene: Scene) -> list[Body]:
        """The machine's own, then those of a scene."""
        return [*self._own.values(), *map(self._other, scene.obstacles)]

    def more(self, scene: Scene) -> dict[str, float]:
        """By link that the arm moves: m to keep to the bodies of a scene beyond the usual padding."""
        if not self._padding:
            return {}
        moved, usual = self._links.moved, self._padding
        return {link: told - usual for link, told in scene.padding if told > usual and link in moved}

    def _other(self, obstacle: Obstacle) -> Body:
        name, mesh = obstacle.name, obstacle.mesh
        key = name, obstacle.box, None if mesh is None else mesh.key
        if self._shown.setdefault(name, key[2]) != key[2]:  # the surface before needs no room any more
            self._shown[name] = key[2]
            self._known = {known: body for known, body in self._known.items() if known[0] != name}
        if key not in self._known:
            self._known[key] = (
                Body(name, obstacle.box, 0.0) if mesh is None else Surface(obstacle, mesh, self._surfaces)
            )
        return self._known[key]

    def pairs(self, scene: Scene) -> NDArray[np.int_]:
        """Numbers of the bodies that must not touch: pairs x 2."""
        others = list(enumerate(scene.obstacles, len(self._own)))
        return np.array([*self._pairs, *((i, j) for i, link in self._moved for j, one in others if one.lets != link)])

    def places(self, poses: Array) -> Matrix:
        """Where the boxes of the machine's own bodies are at the poses: N x bodies x 4 x 4."""
        places = self._links.places(poses)
        return np.stack([places[link] @ body.inner for link, body in self._own.items()], axis=1)

    def between(self, poses: Array, travel: float = TRAVEL) -> tuple[Array, Array]:
        """The poses, and so many on the straight lines between them that nothing moves further than `travel` [m].

        With the number of each, from 0; those between have fractions.
        """
        counts = np.maximum(1, np.ceil(np.abs(np.diff(poses, axis=0)) @ self._reach / travel)).astype(int)
        parts = [i + np.arange(n) / n for i, n in enumerate(counts)]
        numbers = np.concatenate([*parts, [len(poses) - 1.0]])
        known = np.arange(len(poses))
        return np.stack([np.interp(numbers, known, angles) for angles in poses.T], axis=1), numbers
