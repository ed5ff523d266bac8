"""Where the links of a machine are at given joint angles, for many poses at once."""

import itertools
import math
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from tms_config.models import Box, MachineModel

Array = NDArray[np.float64]
Matrix = Array  # 4 x 4, or N x 4 x 4


def placed(x: float, y: float, yaw: float) -> Matrix:
    """A frame on flat ground."""
    found = np.eye(4)
    found[:3, :3] = turned("z", yaw)
    found[:2, 3] = x, y
    return found


def turned(axis: str, angle: float | Array) -> Array:
    """Rotation about one axis by an angle [rad], or by N angles: 3 x 3, or N x 3 x 3."""
    c, s = np.cos(angle), np.sin(angle)
    i, j, k = {"x": (1, 2, 0), "y": (2, 0, 1), "z": (0, 1, 2)}[axis]
    found = np.zeros((*np.shape(angle), 3, 3))
    found[..., i, i] = found[..., j, j] = c
    found[..., i, j], found[..., j, i] = -s, s
    found[..., k, k] = 1.0
    return found


def quaternion(axes: Array) -> list[float]:
    """The quaternion (x, y, z, w) of a rotation: an eigenvector (I. Y. Bar-Itzhack, 2000), without a special case."""
    (a, b, c), (d, e, f), (g, h, i) = axes.tolist()
    matrix = [
        [a - e - i, 0, 0, 0],
        [d + b, e - a - i, 0, 0],
        [g + c, h + f, i - a - e, 0],
        [h - f, c - g, d - b, a + e + i],
    ]
    _, vectors = np.linalg.eigh(np.array(matrix))  # of the lower triangle
    found: list[float] = vectors[:, -1].tolist()
    return found


def box_place(box: Box) -> Matrix:
    """Centre of a box in the frame that it belongs to."""
    found = np.eye(4)
    found[:3, :3] = turned("y", box.pitch)
    found[:3, 3] = found[:3, :3] @ [(low + high) / 2 for low, high in zip(box.min, box.max, strict=True)]
    return found


def box_corners(box: Box) -> Array:
    """Corners of a box in the frame that it belongs to [m], each a column with a 1 below: 4 x 8."""
    found = np.ones((4, 8))
    found[:3] = turned("y", box.pitch) @ np.array(_corners(box)).T
    return found


class Links:
    """Some links of one machine, and those that carry them."""

    def __init__(self, model: MachineModel, links: Iterable[str] | None = None) -> None:
        """`links`: those that matter; None: those that have a body."""
        self.names = tuple(model.joints)  # order of the angles of a pose
        self.moved = _moved(model)
        self.parent = {origin.child: origin.parent for origin in model.geometry.values()}
        self._joint = {origin.child: joint for joint, origin in model.geometry.items()}
        wanted = list(model.shapes if links is None else links)
        carrying = set(wanted)
        for link in wanted:
            while (link := self.parent.get(link, "")) in self.parent:
                carrying.add(link)
        self._steps = [(self._column(j), one) for j, one in model.geometry.items() if one.child in carrying]
        self._fixed = {one.child: turned("y", one.pitch) for _, one in self._steps}

    def _column(self, joint: str) -> int | None:
        return self.names.index(joint) if joint in self.names else None

    def carriers(self, link: str) -> list[str]:
        """The joints that move a link."""
        found = []
        while link in self._joint:
            found.append(self._joint[link])
            link = self.parent[link]
        return [joint for joint in found if joint in self.names]

    def places(self, poses: Array) -> dict[str, Matrix]:
        """The place of every such link in base_link (N x 4 x 4) at N poses [rad, N x joints]."""
        found: dict[str, Matrix] = {"base_link": np.broadcast_to(np.eye(4), (len(poses), 4, 4))}
        for column, origin in self._steps:
            step = np.zeros((len(poses), 4, 4))
            turn = self._fixed[origin.child]
            step[:, :3, :3] = turn if column is None else turn @ turned(origin.axis, poses[:, column])
            step[:, :3, 3], step[:, 3, 3] = origin.xyz, 1.0
            found[origin.child] = found[origin.parent] @ step
        return found


def _moved(model: MachineModel) -> frozenset[str]:
    """Links that the arm moves: everything beyond the upper body."""
    found: set[str] = set()
    for joint, origin in model.geometry.items():
        if origin.parent in found or (joint in model.joints and origin.axis == "y"):
            found.add(origin.child)
    return frozenset(found)


def reaches(model: MachineModel) -> dict[str, float]:
    """By joint: how far [m] a point of a body beyond it can be from its axis at most, in any pose."""
    return {name: _beyond(model.geometry[name].child, model) for name in model.joints}


def reach(model: MachineModel) -> float:
    """How far [m] a point of a body can be from the origin of base_link at most, in any pose."""
    return _beyond("base_link", model)


def _beyond(link: str, model: MachineModel) -> float:
    """Farthest point of a body from the origin of a link that carries it, in any pose [m]; 0 without bodies."""
    own = max((math.hypot(*corner) for corner in _corners(model.shapes.get(link))), default=0.0)
    for origin in model.geometry.values():
        if origin.parent == link and (further := _beyond(origin.child, model)) > 0:
            own = max(own, math.hypot(*origin.xyz) + further)
    return own


def _corners(box: Box | None) -> list[tuple[float, ...]]:
    return [] if box is None else list(itertools.product(*zip(box.min, box.max, strict=True)))
