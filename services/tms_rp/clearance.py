"""Refuses trajectories on which the machine would touch itself or another machine, and names the two.

Bodies are boxes; whether two of them touch is computed by FCL. Coal, its successor, was dropped: it brings boost,
assimp and octomap, ten times the size, for the same boxes. Its Python binding leaks 32 bytes with every collision
object (it frees the memory without the C++ destructor), so each body is one object for ever, which is moved.
"""

import threading
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import fcl
import numpy as np
from numpy.typing import NDArray

from tms_config.models import Box, MachineModel, Origin
from tms_reason.errors import SubtaskFailed
from tms_reason.reason import Reason
from tms_rp.reasons import Collision, Part
from tms_rp.trajectory import Joints, Trajectory

PADDING = 0.1  # m around the bodies that the arm moves
STEP = 0.03  # rad, of the joint that moves most, between two checked samples

Matrix = NDArray[np.float64]  # 4 x 4
Body = str | Reason  # a link of this machine, or the name of an obstacle
Pair = tuple[Body, Body]


@dataclass(frozen=True)
class Obstacle:
    """A body that does not move: its name in reasons, its box, and the place of its frame in our base_link."""

    name: Reason
    box: Box
    place: Matrix


class Clearance:
    """Checks trajectories of one machine."""

    def __init__(self, model: MachineModel) -> None:
        self._model = model
        moved = _moved_links(model)
        self._bodies = {link: _object(box, PADDING if link in moved else 0.0) for link, box in model.shapes.items()}
        self._inner = {link: _box_place(box) for link, box in model.shapes.items()}
        self._others: dict[tuple[Reason, Box], Any] = {}  # bodies of other machines: as many as the site has
        self._looking = threading.Lock()  # guards the places of all bodies
        parent = {origin.child: origin.parent for origin in model.geometry.values()}
        self._pairs = [
            (a, b) for a, b in combinations(self._bodies, 2) if parent.get(a) != b and parent.get(b) != a
        ]  # fmt: skip
        self._moved = moved

    def check(self, made: Trajectory, obstacles: Sequence[Obstacle] = ()) -> None:
        """Check the whole trajectory. Bodies that touch at its start may part, but must be apart at its end.

        Raises:
            SubtaskFailed: Collision, with the two bodies and the time.
        """
        with self._looking:
            self._check(made, {one.name: self._fixed(one) for one in obstacles})

    def _check(self, made: Trajectory, fixed: Mapping[Body, Any]) -> None:
        moving = [link for link in self._bodies if link in self._moved]
        pairs: list[tuple[str | Reason, str | Reason]] = [
            *self._pairs,
            *((link, name) for link in moving for name in fixed),
        ]
        bodies: dict[Body, Any] = {}
        bodies.update(self._bodies)
        bodies.update(fixed)
        looks = _looks(made)
        touching: set[Pair] = set()
        for number, (seconds, positions) in enumerate(looks):
            self._move(dict(zip(made.names, positions, strict=True)))
            now = {pair for pair in pairs if _touch(bodies[pair[0]], bodies[pair[1]])}
            last = number == len(looks) - 1
            bad = now if last else now - touching if number else set()
            if bad:
                first, second = sorted(bad, key=str)[0]
                raise SubtaskFailed(Collision(_part(first), _part(second), seconds))
            touching = now if number == 0 else touching & now

    def _fixed(self, obstacle: Obstacle) -> Any:
        key = obstacle.name, obstacle.box
        if key not in self._others:
            self._others[key] = _object(obstacle.box, 0.0)
        body = self._others[key]
        _place(body, obstacle.place @ _box_place(obstacle.box))
        return body

    def _move(self, positions: Mapping[str, float]) -> None:
        places = {"base_link": np.eye(4)}
        for joint, origin in self._model.geometry.items():
            places[origin.child] = places[origin.parent] @ _step(origin, positions.get(joint, 0.0))
        for link, body in self._bodies.items():
            _place(body, places[link] @ self._inner[link])


def _part(body: Body) -> Reason:
    """A body as a reason names it: of this machine, or an obstacle."""
    return Part(body) if isinstance(body, str) else body


def placed(x: float, y: float, yaw: float) -> Matrix:
    """A frame on flat ground."""
    found = _turned("z", yaw)
    found[:2, 3] = x, y
    return found


def _moved_links(model: MachineModel) -> set[str]:
    """Links that the arm moves: everything beyond the upper body."""
    found: set[str] = set()
    for joint, origin in model.geometry.items():
        if origin.parent in found or (joint in model.joints and origin.axis == "y"):
            found.add(origin.child)
    return found


def _looks(made: Trajectory) -> list[tuple[float, Joints]]:
    """Samples far enough apart to matter, with the first and the last."""
    looks = [(0.0, made.samples[0].positions)]
    for sample in made.samples[1:]:
        if max(abs(a - b) for a, b in zip(sample.positions, looks[-1][1], strict=True)) >= STEP:
            looks.append((sample.time, sample.positions))
    return [*looks, (made.duration, made.samples[-1].positions)]


def _object(box: Box, padding: float) -> Any:
    size = [high - low + 2 * padding for low, high in zip(box.min, box.max, strict=True)]
    return fcl.CollisionObject(fcl.Box(*size))


def _box_place(box: Box) -> Matrix:
    """Centre of a box in the frame that it belongs to."""
    inner = np.eye(4)
    inner[:3, 3] = [(low + high) / 2 for low, high in zip(box.min, box.max, strict=True)]
    return _turned("y", box.pitch) @ inner


def _place(body: Any, place: Matrix) -> None:
    body.setTransform(fcl.Transform(place[:3, :3], place[:3, 3]))


def _touch(a: Any, b: Any) -> bool:
    return bool(fcl.collide(a, b, fcl.CollisionRequest(), fcl.CollisionResult()))


def _step(origin: Origin, angle: float) -> Matrix:
    found = _turned("y", origin.pitch) @ _turned(origin.axis, angle)
    found[:3, 3] = origin.xyz
    return found


def _turned(axis: str, angle: float) -> Matrix:
    c, s = np.cos(angle), np.sin(angle)
    i, j = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    found = np.eye(4)
    found[i, i] = found[j, j] = c
    found[i, j], found[j, i] = -s, s
    return found
