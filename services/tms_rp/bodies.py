"""Bodies as FCL compares them: boxes and surfaces of triangles.

Coal, its successor, was dropped: it brings boost, assimp and octomap, ten times the size, for the same work. FCL's
Python binding leaks 32 bytes with every collision object (it frees the memory without the C++ destructor): so each body
is one object for ever, which is moved.
"""

from functools import cached_property
from typing import Any

import fcl
import numpy as np

from tms_config.models import Box
from tms_control.links import Array, Matrix, box_place
from tms_reason.reason import Reason
from tms_rp.meshes import Mesh
from tms_rp.scene import Obstacle

NOWHERE = (0.0, 0.0, 0.0)


class Surfaces:
    """The geometry of the surface of each name once, whatever it is grown by: that of 10,000 triangles takes 6 MB."""

    def __init__(self) -> None:
        self._known: dict[Reason, tuple[int, Any]] = {}

    def geometry(self, name: Reason, mesh: Mesh, centre: Array) -> Any:
        """FCL's, its corners seen from `centre`."""
        if name not in self._known or self._known[name][0] != mesh.key:
            model = fcl.BVHModel()
            model.beginModel(len(mesh.faces), len(mesh.vertices))
            model.addSubModel(mesh.vertices - centre, mesh.faces)
            model.endModel()
            self._known[name] = mesh.key, model
        return self._known[name][1]


class Body:
    """A box, or what a surface lies in: its name in reasons, its centre in its frame, half of its size [m].

    `slack`: what comes nearer to a surface than this [m] touches it.
    """

    def __init__(self, name: Reason, box: Box, padding: float) -> None:
        self.name, self.inner, self.slack = name, box_place(box), 0.0
        self.bare = np.array([(high - low) / 2 for low, high in zip(box.min, box.max, strict=True)])
        self.half = self.bare + padding
        self.padding = padding

    @cached_property
    def _padded(self) -> Any:
        return fcl.CollisionObject(self._geometry(self.half))

    @cached_property
    def _bare(self) -> Any:
        return fcl.CollisionObject(self._geometry(self.bare)) if self.padding > 0 else self._padded

    def _geometry(self, half: Array) -> Any:
        return fcl.Box(*map(float, 2 * half))

    def at(self, place: Matrix, padded: bool = True) -> Any:
        """FCL's object, put to a place."""
        found = self._padded if padded else self._bare
        found.setTransform(fcl.Transform(place[:3, :3], place[:3, 3]))
        return found


class Surface(Body):
    """A surface of triangles."""

    def __init__(self, obstacle: Obstacle, mesh: Mesh, surfaces: Surfaces) -> None:
        super().__init__(obstacle.name, obstacle.box, 0.0)
        self.slack = mesh.off + obstacle.growth
        self._mesh, self._surfaces = mesh, surfaces

    def _geometry(self, half: Array) -> Any:
        return self._surfaces.geometry(self.name, self._mesh, self.inner[:3, 3])


def gap(a: Any, b: Any, slack: float) -> float:
    """How far two of FCL's objects are apart [m]; 0 where they overlap."""
    return max(0.0, float(fcl.distance(a, b, fcl.DistanceRequest(), fcl.DistanceResult())) - slack)


def touch(a: Any, b: Any, slack: float) -> bool:
    """Whether two of FCL's objects come nearer than `slack` [m]."""
    if fcl.collide(a, b, fcl.CollisionRequest(), fcl.CollisionResult()):
        return True
    return slack > 0 and gap(a, b, slack) <= 0


def overlap(a: Any, b: Any, slack: float) -> tuple[float, tuple[float, ...]]:
    """How deep two of FCL's objects overlap [m] and where, in base_link."""
    result = fcl.CollisionResult()
    fcl.collide(a, b, fcl.CollisionRequest(num_max_contacts=8, enable_contact=True), result)
    found = [(abs(float(one.penetration_depth)) + slack, tuple(map(float, one.pos))) for one in result.contacts]
    if found or slack <= 0:
        return max(found, default=(0.0, NOWHERE))
    near = fcl.DistanceResult()
    apart = fcl.distance(a, b, fcl.DistanceRequest(enable_nearest_points=True), near)
    return max(0.0, slack - float(apart)), tuple(map(float, near.nearest_points[0]))
