"""Whether a machine would touch itself or something in a scene: the one collision checker of the planner."""

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import combinations
from typing import ParamSpec

import numpy as np
from numpy.typing import NDArray

from tms_config.models import MachineModel
from tms_control.links import Array, Links, Matrix, reaches
from tms_rp.bodies import Body, Surface, Surfaces
from tms_rp.reasons import Part
from tms_rp.scene import Obstacle, Scene
from tms_rp.trajectory import Trajectory
from tms_rp.view import View

PADDING = 0.1  # m, usual
# m that no point of the machine moves further between two checked poses: it is never further than PADDING from one.
TRAVEL = 2 * PADDING

P = ParamSpec("P")


class Clearance:
    """Looks at scenes for one machine; `padding`: m around the bodies that the arm moves."""

    def __init__(self, model: MachineModel, padding: float = PADDING) -> None:
        self._links = links = Links(model)
        self._reach = np.array(list(reaches(model).values()))
        self._shapes, self._padding = model.shapes, padding
        self._own = {link: self._padded(link, padding) for link in model.shapes}
        self._known: dict[
            object, Body
        ] = {}  # bodies in scenes, as many as the site has, and own ones with more padding
        self._surfaces = Surfaces()
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

    def bodies(self, scene: Scene) -> list[Body]:
        """The machine's own, with the padding of a scene where that is more, then those of the scene."""
        told = dict(scene.padding) if self._padding else {}
        own = [
            body
            if told.get(link, 0.0) <= self._padding
            else self._once((link, told[link]), self._padded, link, told[link])
            for link, body in self._own.items()
        ]
        return [*own, *map(self._other, scene.obstacles)]

    def _padded(self, link: str, padding: float) -> Body:
        return Body(Part(link), self._shapes[link], padding if link in self._links.moved else 0.0)

    def _other(self, obstacle: Obstacle) -> Body:
        mesh = obstacle.mesh
        if mesh is None:
            return self._once((obstacle.name, obstacle.box), Body, obstacle.name, obstacle.box, 0.0)
        return self._once((obstacle.name, obstacle.box, mesh.key), Surface, obstacle, mesh, self._surfaces)

    def _once(self, key: object, make: Callable[P, Body], *given: P.args, **named: P.kwargs) -> Body:
        if key not in self._known:
            self._known[key] = make(*given, **named)
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
