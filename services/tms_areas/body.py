"""A machine from above, as the areas' law sees it: convex parts in base_link [m] that hold all of it at given joints.

An upper body that turns is a circle with all of its arm inside, since the swing is the fastest motion and may go on for
a while after a stop. Heights do not count.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tms_config.models import MachineModel
from tms_control.from_above import around_circle, from_above, hull
from tms_control.links import Links, box_corners, reach

SIDES = 32  # of a polygon around a circle: at most half a percent larger
FINEST = 0.05  # rad between two looks at an arm on its way: in between it reaches millimetres further at most

Array = NDArray[np.float64]
ROUND: Array = np.array(around_circle(0.0, 0.0, 1.0, SIDES))


@dataclass(frozen=True)
class Part:
    """A convex part; `spin`: the radius [m] at which its points turn with the base. A circle turns with its centre."""

    corners: Array  # K x 2
    spin: float


@dataclass(frozen=True)
class Body:
    """A machine at its joints."""

    parts: tuple[Part, ...]


class Silhouette:
    """Makes bodies of one model."""

    def __init__(self, model: MachineModel) -> None:
        self._joints = tuple(model.joints)
        self._fixed = tuple(_part(np.array(corners)) for corners in from_above(model).values())
        self._axis, beyond = _swinging(model)
        self._links = Links(model, beyond)
        self._corners = {link: box_corners(model.shapes[link]) for link in beyond}
        whole = _circle(0.0, 0.0, reach(model))
        self._anywhere = Body((*self._fixed, whole))
        self.most = max(part.spin for part in (*self._fixed, _part(whole.corners)))  # m from the base, in any pose

    def body(self, joints: Sequence[Mapping[str, float]]) -> Body:
        """What holds it at all of these joints [rad]; at a joint that is not told it may be anywhere."""
        if not self._corners:
            return Body(self._fixed)
        if not joints or any(name not in pose for pose in joints for name in self._joints):
            return self._anywhere
        poses = np.array([[pose[name] for name in self._joints] for pose in joints])
        places = self._links.places(poses)
        at = [(places[link] @ corners)[:, :2].transpose(0, 2, 1) for link, corners in self._corners.items()]
        found = np.concatenate(at, axis=1).reshape(-1, 2)
        if self._axis is None:
            return Body((*self._fixed, _part(np.array(hull(map(tuple, found))))))
        x, y = self._axis
        return Body((*self._fixed, _circle(x, y, float(np.hypot(found[:, 0] - x, found[:, 1] - y).max()))))

    def swept(self, way: Sequence[Mapping[str, float]]) -> Body:
        """What holds it on a way of straight lines between joints; the first one is where it is."""
        return self.body(_looks(way))

    def stages(self, way: Sequence[Mapping[str, float]]) -> list[Body]:
        """It at places on such a way, one after the other."""
        return [self.body([one]) for one in _looks(way)]


def _looks(way: Sequence[Mapping[str, float]]) -> list[Mapping[str, float]]:
    """Joints on a way; those that a place of it does not tell stay."""
    looks = list(way[:1])
    old: Mapping[str, float] = way[0] if way else {}
    for new in way[1:]:
        told = {**old, **new}
        most = max((abs(told[name] - old.get(name, told[name])) for name in told), default=0.0)
        for share in np.linspace(0.0, 1.0, 1 + math.ceil(most / FINEST))[1:]:
            looks.append({name: old.get(name, to) * (1 - share) + to * share for name, to in told.items()})
        old = told
    return looks


def _swinging(model: MachineModel) -> tuple[tuple[float, float] | None, list[str]]:
    """The axis about which an upper body turns (None: none does), and the links with a body whose place joints change.

    Of a machine that swings these are the links beyond the swing.
    """
    place, moved, swung = {"base_link": (0.0, 0.0)}, set[str](), set[str]()
    axis = None
    for name, origin in model.geometry.items():
        x, y = place[origin.parent]
        place[origin.child] = x + origin.xyz[0], y + origin.xyz[1]
        if name in model.joints and origin.axis == "z" and origin.parent not in moved and axis is None:
            axis = place[origin.child]
            swung.add(origin.child)
        if origin.parent in swung:
            swung.add(origin.child)
        if name in model.joints or origin.parent in moved:
            moved.add(origin.child)
    wanted = moved if axis is None else swung
    return axis, [link for link in model.shapes if link in wanted]


def _part(corners: Array) -> Part:
    return Part(corners, float(np.hypot(*corners.T).max()))


def _circle(x: float, y: float, radius: float) -> Part:
    return Part(ROUND * radius + (x, y), math.hypot(x, y))
