"""A planner's scene as messages: for programs, and as markers that RViz draws."""

from collections.abc import Iterable, Sequence

import numpy as np
from geometry_msgs.msg import Point, Pose, Quaternion, Vector3
from std_msgs.msg import ColorRGBA
from tms_msg_rp.msg import SceneArea, SceneBody
from visualization_msgs.msg import Marker, MarkerArray

from tms_control.links import Matrix, quaternion
from tms_reason.wire import to_line
from tms_rp import scene_view as view
from tms_rp.meshes import Mesh

COLOURS = {view.OWN: (0.2, 0.6, 1.0), view.MACHINE: (1.0, 0.6, 0.1), view.RECORD: (0.9, 0.2, 0.2)}  # red, green, blue
AREA, WAY = (0.3, 0.8, 0.3), (1.0, 1.0, 1.0)
SOLID, FAINT = 0.8, 0.15  # how little is seen through a body, and through its margin
POINT = 0.3  # m, an area without a size
LINE = 0.05  # m, breadth of the way


def body(shown: view.Shown) -> SceneBody:
    """A body."""
    corners = [] if shown.mesh is None else _corners(shown.mesh, shown.place)
    return SceneBody(
        kind=shown.kind, name=to_line(shown.name), pose=_pose(shown.place), size=_vector(shown.sides),
        margin=shown.margin, age=shown.age, triangles=corners,
    )  # fmt: skip


def area(one: view.Area) -> SceneArea:
    """An area."""
    return SceneArea(record=one.record, centre=_spot(one.centre), size=_vector(one.sides))


def way(places: Iterable[view.Point]) -> list[Point]:
    """Places of the tip."""
    return [_spot(one) for one in places]


def markers(frame: str, bodies: Sequence[SceneBody], areas: Sequence[SceneArea], tip: Sequence[Point]) -> MarkerArray:
    """All of it, in place of what was drawn before; `frame`: base_link of the machine."""
    found = [Marker(action=Marker.DELETEALL)]
    for one in bodies:
        rgb = COLOURS[one.kind]
        found.append(_surface(one, rgb) if one.triangles else _cube(one.pose, one.size, rgb, SOLID))
        if one.margin > 0:
            size = Vector3(**{axis: getattr(one.size, axis) + 2 * one.margin for axis in "xyz"})
            found.append(_cube(one.pose, size, rgb, FAINT))
    for place in areas:
        size = Vector3(**{axis: getattr(place.size, axis) or POINT for axis in "xyz"})
        found.append(_cube(Pose(position=place.centre), size, AREA, FAINT))
    if tip:
        found.append(Marker(type=Marker.LINE_STRIP, points=list(tip), scale=Vector3(x=LINE), color=_colour(WAY, 1.0)))
    for number, marker in enumerate(found):
        marker.header.frame_id, marker.ns, marker.id = frame, "scene", number
    return MarkerArray(markers=found)


def refusal_marker(frame: str, why: str) -> MarkerArray:
    """A text over the machine in place of all that was drawn before: why the scene is not known."""
    said = Marker(type=Marker.TEXT_VIEW_FACING, text=why, scale=Vector3(z=0.5), color=_colour(WAY, 1.0))
    said.pose.position.z, said.pose.orientation.w, said.header.frame_id = 5.0, 1.0, frame
    return MarkerArray(markers=[Marker(action=Marker.DELETEALL), said])


def _cube(pose: Pose, size: Vector3, rgb: tuple[float, float, float], alpha: float) -> Marker:
    return Marker(type=Marker.CUBE, pose=pose, scale=size, color=_colour(rgb, alpha))


def _surface(one: SceneBody, rgb: tuple[float, float, float]) -> Marker:
    unit = Vector3(x=1.0, y=1.0, z=1.0)
    return Marker(type=Marker.TRIANGLE_LIST, pose=one.pose, points=one.triangles, scale=unit, color=_colour(rgb, SOLID))


def _colour(rgb: tuple[float, float, float], alpha: float) -> ColorRGBA:
    return ColorRGBA(r=rgb[0], g=rgb[1], b=rgb[2], a=alpha)


def _corners(mesh: Mesh, place: Matrix) -> list[Point]:
    """Corners of the triangles, seen from the centre of the box."""
    used = mesh.vertices[mesh.faces.ravel()]
    low, high = np.array(mesh.box.min), np.array(mesh.box.max)
    return [_spot(one) for one in (used - (low + high) / 2).tolist()]


def _pose(place: Matrix) -> Pose:
    x, y, z, w = quaternion(place[:3, :3])
    return Pose(position=_spot(place[:3, 3].tolist()), orientation=Quaternion(x=x, y=y, z=z, w=w))


def _spot(at: Sequence[float]) -> Point:
    return Point(x=at[0], y=at[1], z=at[2])


def _vector(sides: Sequence[float]) -> Vector3:
    return Vector3(x=sides[0], y=sides[1], z=sides[2])
