"""Whether a machine would touch itself or something in a scene: the one collision checker of the planner.

Bodies are boxes; whether two of them touch is computed by FCL. Coal, its successor, was dropped: it brings boost,
assimp and octomap, ten times the size, for the same boxes. Its Python binding leaks 32 bytes with every collision
object (it frees the memory without the C++ destructor), so each body is one object for ever, which is moved. Most
pairs are told apart beforehand, for all poses at once, by the extents of their bodies along the axes of base_link.
"""

import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from itertools import combinations
from typing import Any

import fcl
import numpy as np
from numpy.typing import NDArray

from tms_config.models import Box, MachineModel
from tms_reason.errors import SubtaskFailed
from tms_reason.reason import Reason
from tms_rp.links import Array, Links, Matrix, box_place, reaches
from tms_rp.reasons import Collision, Ground, Part
from tms_rp.scene import Obstacle, Scene
from tms_rp.trajectory import Trajectory

PADDING = 0.1  # m around the bodies that the arm moves
# m that no point of the machine moves further between two checked poses: it is never further than PADDING from one.
TRAVEL = 2 * PADDING

Mask = NDArray[np.bool_]


class Clearance:
    """Looks at scenes for one machine."""

    def __init__(self, model: MachineModel) -> None:
        self.links = links = Links(model)
        self._reach = reaches(model)
        self._bodies = {
            link: _Body(Part(link), box, PADDING if link in links.moved else 0.0) for link, box in model.shapes.items()
        }
        self._others: dict[tuple[Reason, Box], _Body] = {}  # bodies in scenes: as many as the site has
        self._looking = threading.Lock()  # guards the places of all bodies
        # Neighbours along the arm, and links of the arm among each other, are kept apart by the joint limits.
        self._pairs = [
            (a, b) for a, b in combinations(self._bodies, 2)
            if links.parent.get(a) != b and links.parent.get(b) != a and not {a, b} <= links.moved
        ]  # fmt: skip

    @contextmanager
    def looking(self, scene: Scene) -> Iterator["View"]:
        """A look at a scene; others wait meanwhile."""
        with self._looking:
            yield View(self, scene)

    def check(self, made: Trajectory, scene: Scene) -> None:
        """Check a whole trajectory, as View.check."""
        with self.looking(scene) as view:
            view.check(made)

    def pairs(self, scene: Scene) -> list[tuple["_Body", "_Body"]]:
        """What must not touch."""
        own = [(self._bodies[a], self._bodies[b]) for a, b in self._pairs]
        fixed = [self._fixed(one) for one in scene.obstacles]
        return own + [(self._bodies[a], other) for a in self._bodies if a in self.links.moved for other in fixed]

    def _fixed(self, obstacle: Obstacle) -> "_Body":
        key = obstacle.name, obstacle.box
        if key not in self._others:
            self._others[key] = _Body(obstacle.name, obstacle.box, 0.0)
        body = self._others[key]
        body.put((obstacle.place @ body.inner)[None])
        return body

    def put(self, poses: Array) -> None:
        """Put the machine's own bodies where they are at the poses."""
        places = self.links.places(poses)
        for link, body in self._bodies.items():
            body.put(places[link] @ body.inner)

    def between(self, poses: Array) -> tuple[Array, Array]:
        """The poses, and so many on the straight lines between them that nothing moves further than TRAVEL.

        With the number of each, from 0; those between have fractions.
        """
        counts = np.maximum(1, np.ceil(np.abs(np.diff(poses, axis=0)) @ self._reach / TRAVEL)).astype(int)
        parts = [i + np.arange(n) / n for i, n in enumerate(counts)]
        numbers = np.concatenate([*parts, [len(poses) - 1.0]])
        known = np.arange(len(poses))
        return np.stack([np.interp(numbers, known, angles) for angles in poses.T], axis=1), numbers


class View:
    """One look at one scene, while the bodies belong to it."""

    def __init__(self, clearance: Clearance, scene: Scene) -> None:
        self._clearance, self.scene = clearance, scene
        self._pairs = clearance.pairs(scene)

    def contacts(self, poses: Array) -> Mask:
        """Which pairs of bodies touch at which poses [rad, N x joints]: N x pairs."""
        self._clearance.put(poses)
        found = np.stack([_near(a, b, len(poses)) for a, b in self._pairs], axis=1)
        for pose, pair in np.argwhere(found):
            a, b = self._pairs[pair]
            found[pose, pair] = fcl.collide(a.at(pose), b.at(pose), fcl.CollisionRequest(), fcl.CollisionResult())
        return found

    def free(self, *poses: Sequence[float]) -> bool:
        """Whether nothing touches at the poses, nor on the straight lines between them."""
        return not self.contacts(self._clearance.between(np.array(poses))[0]).any()

    def check(self, made: Trajectory) -> None:
        """Check a whole trajectory.

        What touches at its start may part, but must be apart at its end; only into the ground it may lead.

        Raises:
            SubtaskFailed: Collision, with the two bodies, the time, and where they overlap most.
        """
        poses, numbers = self._clearance.between(np.array([sample.positions for sample in made.samples]))
        contacts = self.contacts(poses)
        bad = contacts & ~_run(contacts)
        bad[-1] = contacts[-1]
        soil = [isinstance(b.name, Ground) for _, b in self._pairs]
        bad[:, soil] &= ~_run(contacts[::-1])[::-1][:, soil]
        if bad.any():
            times = np.interp(numbers, range(len(made.samples)), [sample.time for sample in made.samples])
            raise SubtaskFailed(self._collision(times, bad))

    def check_end(self, made: Trajectory) -> None:
        """Check the last pose alone.

        Raises:
            SubtaskFailed: Collision, after the whole time.
        """
        bad = self.contacts(np.array([made.samples[-1].positions]))
        if bad.any():
            raise SubtaskFailed(self._collision(np.array([made.duration]), bad))

    def _collision(self, times: Array, bad: Mask) -> Collision:
        first = int(np.argmax(bad.any(axis=1)))
        pair = int(np.argmax(bad[first]))
        a, b = self._pairs[pair]
        overlaps = [self._overlap(a, b, int(pose)) for pose in np.flatnonzero(bad[:, pair])]
        depth, (x, y, z) = max(overlaps, key=lambda one: one[0])
        return Collision(a.name, b.name, float(times[first]), depth, x, y, z)

    @staticmethod
    def _overlap(a: "_Body", b: "_Body", pose: int) -> tuple[float, tuple[float, float, float]]:
        """How deep two bodies overlap [m] and where, in base_link."""
        result = fcl.CollisionResult()
        fcl.collide(a.at(pose), b.at(pose), fcl.CollisionRequest(num_max_contacts=8, enable_contact=True), result)
        deepest = max(result.contacts, key=lambda one: one.penetration_depth)
        x, y, z = map(float, deepest.pos)
        return float(deepest.penetration_depth), (x, y, z)


class _Body:
    """A box, and the places where it is looked at."""

    def __init__(self, name: Reason, box: Box, padding: float) -> None:
        self.name, self.inner = name, box_place(box)
        self._half = np.array([(high - low) / 2 + padding for low, high in zip(box.min, box.max, strict=True)])
        self._object = fcl.CollisionObject(fcl.Box(*map(float, 2 * self._half)))
        self._places: Matrix = self.inner[None]
        self.extent = self._half[None]  # half of what it takes along the axes of base_link, m

    def put(self, places: Matrix) -> None:
        self._places = places
        self.extent = np.abs(places[:, :3, :3]) @ self._half

    @property
    def centre(self) -> Array:
        return self._places[:, :3, 3]

    def at(self, pose: int) -> Any:
        """FCL's object at one of the places; an obstacle has one for all."""
        place = self._places[pose if len(self._places) > 1 else 0]
        self._object.setTransform(fcl.Transform(place[:3, :3], place[:3, 3]))
        return self._object


def _near(a: _Body, b: _Body, count: int) -> Mask:
    """At which poses two bodies are so near that they may touch."""
    near: Mask = (np.abs(a.centre - b.centre) <= a.extent + b.extent).all(axis=1)
    return np.broadcast_to(near, count).copy()


def _run(contacts: Mask) -> Mask:
    """The contacts that last since the first pose."""
    return np.logical_and.accumulate(contacts, axis=0)
