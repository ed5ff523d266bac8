"""One look at one scene by one machine: what touches, where, and how near things come to each other.

FCL is asked only for boxes that no face of either separates: that is found beforehand, for all poses and pairs at once.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from tms_control.links import Array, Matrix
from tms_reason.errors import SubtaskFailed
from tms_reason.reason import Reason
from tms_rp.bodies import Body, gap, overlap, touch
from tms_rp.reasons import Between, Collision, Ground, Part
from tms_rp.scene import Scene
from tms_rp.trajectory import Trajectory

ROUNDING = 1e-9  # m
# Bodies of which only the padding touches at the start are looked at without it, in steps of FINE [m], to keep NEAR [m]
# apart, or as far as they are then. Those that overlap may part on any way: how deep they do is no measure of how far.
FINE = 0.02
NEAR = 0.02

Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class Nearest:
    """The two bodies that come nearest to each other, how near [m], and when [s]."""

    first: Reason
    second: Reason
    distance: float
    seconds: float


class Machine(Protocol):
    """The machine that looks (clearance.py)."""

    def bodies(self, scene: Scene) -> list[Body]:
        """Its own bodies, then those of a scene."""

    def pairs(self, scene: Scene) -> NDArray[np.int_]:
        """Numbers of the bodies that must not touch: pairs x 2."""

    def more(self, scene: Scene) -> dict[str, float]:
        """By link: m to keep to the bodies of a scene beyond the usual padding."""

    def places(self, poses: Array) -> Matrix:
        """Where its own bodies are at the poses: N x bodies x 4 x 4."""

    def between(self, poses: Array, travel: float = ...) -> tuple[Array, Array]:
        """The poses and those between them, `travel` [m] apart at most, with the number of each."""


class View:
    """One look at one scene, while the bodies belong to it."""

    def __init__(self, machine: "Machine", scene: Scene) -> None:
        self._machine, self.scene = machine, scene
        self._bodies = machine.bodies(scene)
        self._pairs = machine.pairs(scene)
        own, more = len(self._bodies) - len(scene.obstacles), machine.more(scene)
        self._more = np.array([more.get(_link(self._bodies[i].name), 0.0) if j >= own else 0.0 for i, j in self._pairs])
        self._slack = [more + self._bodies[j].slack for more, (_, j) in zip(self._more, self._pairs, strict=True)]
        self._half = np.array([body.half for body in self._bodies])
        inner = [body.inner for body in self._bodies[-len(scene.obstacles) :]] if scene.obstacles else []
        self._others = np.array([one.place @ box for one, box in zip(scene.obstacles, inner, strict=True)])

    def free(self, *poses: Sequence[float]) -> bool:
        """Whether nothing touches at the poses, nor on the straight lines between them."""
        places = self._places(self._machine.between(np.array(poses))[0])
        return not any(self._touch(places, pose, pair) for pose, pair in self._near(places))

    def passable(self, poses: Sequence[Sequence[float]]) -> bool:
        """Whether `check` would pass a trajectory on the straight lines between the poses."""
        between, _ = self._machine.between(np.array(poses))
        return not self._bad(between, self._places(between)).any()

    def check(self, made: Trajectory) -> None:
        """Check a whole trajectory.

        What touches at its start may part, but must be apart at its end; only into the ground it may lead, at its end.

        Raises:
            SubtaskFailed: Collision, with the two bodies, the time, and where they overlap most.
        """
        poses, numbers = self._machine.between(np.array([sample.positions for sample in made.samples]))
        times = np.interp(numbers, range(len(made.samples)), [sample.time for sample in made.samples])
        places = self._places(poses)
        self._refuse(places, times, self._bad(poses, places))

    def _bad(self, poses: Array, places: Matrix) -> Mask:
        """The contacts that `check` does not allow."""
        contacts = self._contacts(places)
        since = _run(contacts)
        bad = contacts & ~since
        bad[-1] = contacts[-1]
        for pair in np.flatnonzero(contacts[0]):
            bad[: since[:, pair].sum(), pair] |= self._nearer(poses[since[:, pair]], int(pair))
        soil = np.array([isinstance(self._bodies[b].name, Ground) for _, b in self._pairs])
        bad[:, soil] &= ~_run(contacts[::-1])[::-1][:, soil]
        return bad

    def _nearer(self, poses: Array, pair: int) -> Mask:
        """At which poses, or before the next one, bodies come too near of which the padding touches at the first."""
        fine, numbers = self._machine.between(poses, FINE)
        places, found = self._places(fine), np.zeros(len(poses), dtype=bool)
        least = min(self._gap(places, 0, pair), NEAR) - ROUNDING
        if least <= 0:
            return found
        gaps = np.array([self._gap(places, pose, pair) for pose in range(len(fine))])
        found[numbers[gaps < least].astype(int)] = True
        return found

    def _gap(self, places: Matrix, pose: int, pair: int) -> float:
        """How far two bodies are apart [m], without padding; 0 where they overlap."""
        a, b = (self._bodies[i].at(places[pose, i], padded=False) for i in self._pairs[pair])
        return gap(a, b, self._slack[pair])

    def overlap(self, pose: Sequence[float]) -> Reason | None:
        """Two bodies that touch at a pose."""
        for _, pair in np.argwhere(self._contacts(self._places(np.array([pose])))):
            return Between(*(self._bodies[i].name for i in self._pairs[pair]))
        return None

    def depths(self, poses: Array) -> Array:
        """How deep all overlaps at poses are [m, the sum]: N."""
        places, found = self._places(poses), np.zeros(len(poses))
        for pose, pair in np.argwhere(self._contacts(places)):
            i, j = self._pairs[pair]
            a, b = self._bodies[i].at(places[pose, i]), self._bodies[j].at(places[pose, j])
            found[pose] += overlap(a, b, self._slack[pair])[0]
        return found

    def check_part(self, made: Trajectory, begin: float, end: float) -> None:
        """Check a trajectory that runs between two times [s]; what touches since its start may go on.

        Raises:
            SubtaskFailed: Collision.
        """
        samples = [sample for sample in made.samples if sample.time <= end]
        poses, numbers = self._machine.between(np.array([sample.positions for sample in samples]))
        times = np.interp(numbers, range(len(samples)), [sample.time for sample in samples])
        places = self._places(poses)
        contacts = self._contacts(places)
        self._refuse(places, times, contacts & ~_run(contacts) & (times >= begin)[:, None])

    def check_end(self, made: Trajectory) -> None:
        """Check the last pose alone.

        Raises:
            SubtaskFailed: Collision, after the whole time.
        """
        places = self._places(np.array([made.samples[-1].positions]))
        self._refuse(places, np.array([made.duration]), self._contacts(places))

    def nearest(self, made: Trajectory) -> Nearest | None:
        """Where a trajectory comes nearest to something, among its samples; None if there is nothing."""
        places = self._places(np.array([sample.positions for sample in made.samples]))
        centres, radii = places[..., :3, 3], np.linalg.norm(self._half, axis=1)
        a, b = self._pairs.T
        least = np.linalg.norm(centres[:, b] - centres[:, a], axis=2) - radii[a] - radii[b]  # by their spheres
        found: Nearest | None = None
        for pose, pair in zip(*np.unravel_index(np.argsort(least, axis=None), least.shape), strict=True):
            if found is not None and least[pose, pair] >= found.distance:
                break
            distance = self._gap(places, pose, pair)
            if found is None or distance < found.distance:
                first, second = (self._bodies[i].name for i in self._pairs[pair])
                found = Nearest(first, second, distance, made.samples[pose].time)
        return found

    def _places(self, poses: Array) -> Matrix:
        """Where all boxes are: N x bodies x 4 x 4."""
        own = self._machine.places(poses)
        if not len(self._others):
            return own
        return np.concatenate([own, np.broadcast_to(self._others, (len(poses), *self._others.shape))], axis=1)

    def _near(self, places: Matrix) -> NDArray[np.int_]:
        """Numbers of the poses, and the pairs that no face of either box separates there; all others are apart."""
        turns, centres = places[..., :3, :3], places[..., :3, 3]
        a, b = self._pairs.T
        ways = centres[:, b] - centres[:, a]
        far = np.linalg.norm(self._half[a], axis=1) + np.linalg.norm(self._half[b], axis=1) + self._more
        found = np.argwhere(np.einsum("npi,npi->np", ways, ways) <= far**2)
        poses, pairs = found.T
        a, b, way = a[pairs], b[pairs], ways[poses, pairs][..., None]
        turn_a, turn_b = turns[poses, a].swapaxes(1, 2), turns[poses, b].swapaxes(1, 2)  # from base_link
        across = np.abs(turn_a @ turn_b.swapaxes(1, 2))
        half_a, half_b = self._half[a, :, None], self._half[b, :, None]
        more = self._more[pairs, None, None] + ROUNDING
        over_a = np.abs(turn_a @ way) <= half_a + across @ half_b + more
        over_b = np.abs(turn_b @ way) <= half_b + across.swapaxes(1, 2) @ half_a + more
        near: NDArray[np.int_] = found[(over_a & over_b).all(axis=(1, 2))]
        return near

    def _contacts(self, places: Matrix) -> Mask:
        """Which pairs touch at which pose: N x pairs."""
        found = np.zeros((len(places), len(self._pairs)), dtype=bool)
        for pose, pair in self._near(places):
            found[pose, pair] = self._touch(places, pose, pair)
        return found

    def _touch(self, places: Matrix, pose: int, pair: int) -> bool:
        a, b = (self._bodies[i].at(places[pose, i]) for i in self._pairs[pair])
        return touch(a, b, self._slack[pair])

    def _refuse(self, places: Matrix, times: Array, bad: Mask) -> None:
        if not bad.any():
            return
        first = int(np.argmax(bad.any(axis=1)))
        pair = int(np.argmax(bad[first]))
        a, b = (self._bodies[i] for i in self._pairs[pair])
        i, j = self._pairs[pair]
        depth, (x, y, z) = max(
            overlap(a.at(places[pose, i]), b.at(places[pose, j]), self._slack[pair])
            for pose in np.flatnonzero(bad[:, pair])
        )
        raise SubtaskFailed(Collision(a.name, b.name, float(times[first]), depth, x, y, z))


def _link(name: Reason) -> str:
    return name.link if isinstance(name, Part) else ""


def _run(contacts: Mask) -> Mask:
    """The contacts that last since the first pose."""
    return np.logical_and.accumulate(contacts, axis=0)
