"""What is shown of a scene: own bodies, others with age and margin, surfaces, areas, the way of the tip."""

import math
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from geometry_msgs.msg import Point
from tms_msg_rp.msg import SceneBody
from tms_msg_rp.srv import GetScene
from visualization_msgs.msg import Marker

from tms_config.config import CONFIGS
from tms_config.models import Box, MachineModel
from tms_config.yaml_file import parse
from tms_control.links import placed, turned
from tms_reason.errors import SubtaskFailed
from tms_reason.wire import of, to_line
from tms_rp import scene_messages as messages
from tms_rp.clearance import PADDING, Clearance
from tms_rp.meshes import Mesh
from tms_rp.reasons import JointsUnheard, Part, PartOf, Told
from tms_rp.scene import Obstacle, Scene
from tms_rp.scene_server import SceneServer
from tms_rp.scene_view import Area, Shown, bodies, way_of_tip
from tms_rp.trajectory import trajectory

MODEL = parse(CONFIGS / "machines" / "zx200.yaml", MachineModel)
POSE = (0.0, -0.8, 2.0, 0.8, 0.0)
CUBE = Box(min=(-1.0, -1.0, 0.0), max=(1.0, 1.0, 4.0))
TRUCK = Obstacle(PartOf("vessel", "ic120_1"), CUBE, placed(8.0, 2.0, 0.5), 3.0)
CORNERS = np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 1.0]])
HEAP = Mesh(CORNERS, np.array([[0, 1, 2]]), 0.05)
MOUND = Obstacle(Told("collision_object_heap"), HEAP.box, placed(0.0, 7.0, 0.0), 1.5, mesh=HEAP)


def shown(scene: Scene) -> list[Shown]:
    return bodies(Clearance(MODEL), scene, POSE)


def test_own_bodies_have_their_padding() -> None:
    found = {str(one.name): one for one in shown(Scene(padding=(("bucket_link", 0.4),)))}
    assert {name: one.margin for name, one in found.items()} == {
        str(Part(link)): {"bucket_link": 0.4, "boom_link": PADDING, "arm_link": PADDING}.get(link, 0.0)
        for link in MODEL.shapes
    }
    assert {one.kind for one in found.values()} == {"own"}
    tracks = found[str(Part("track_link"))]
    assert tracks.sides == pytest.approx((4.35, 3.578, 1.121)) and tracks.place[2, 3] == pytest.approx(0.5605)


def test_what_a_machine_may_have_moved_is_margin_and_not_size() -> None:
    *_, one = shown(Scene((TRUCK.grown(0.3),)))
    assert (one.kind, one.name, one.age, one.margin) == ("machine", TRUCK.name, 3.0, 0.5)
    assert one.sides == pytest.approx((2.0, 2.0, 4.0))
    assert one.place[:3, 3] == pytest.approx([8.0, 2.0, 2.0])


def test_a_surface_is_drawn_where_it_is() -> None:
    *_, one = shown(Scene((MOUND,)))
    assert (one.kind, one.margin) == ("record", pytest.approx(0.05))
    told = messages.body(one)
    at = told.pose.position
    corners = np.array([[p.x + at.x, p.y + at.y, p.z + at.z] for p in told.triangles])
    assert corners == pytest.approx(CORNERS + np.array([0.0, 7.0, 0.0]))


@pytest.mark.parametrize("axis", ["x", "y", "z"])
@pytest.mark.parametrize("angle", [0.0, 0.4, -2.0, math.pi])
def test_a_turn_is_told_as_a_quaternion(axis: str, angle: float) -> None:
    place = np.eye(4)
    place[:3, :3] = turned(axis, angle)
    q = messages.body(Shown("own", Part("arm_link"), place, (1.0, 1.0, 1.0), 0.0)).pose.orientation
    found = {"x": q.x, "y": q.y, "z": q.z}
    assert abs(found[axis] * math.sin(angle / 2) + q.w * math.cos(angle / 2)) == pytest.approx(1.0)


def test_the_way_of_the_tip_begins_and_ends_at_its_poses() -> None:
    made = trajectory(MODEL.joints, POSE, [(1.5, -0.8, 2.0, 0.8, 0.0)])
    way = way_of_tip(MODEL, made)
    assert 20 < len(way) <= 60
    assert math.hypot(*way[0][:2]) == pytest.approx(math.hypot(*way[-1][:2]), abs=0.2)
    assert way[0][0] > 4 and way[-1][1] > 4
    here = way_of_tip(MODEL, trajectory(MODEL.joints, POSE, ()))
    assert here[0] == pytest.approx(way[0])


def test_markers_replace_those_before_and_show_margins_faintly() -> None:
    told = [messages.body(one) for one in shown(Scene((TRUCK.grown(0.3), MOUND)))]
    area = messages.area(Area("dig", (5.0, 0.0, 0.0), (2.0, 1.0, 0.0)))
    found = messages.markers("zx200/base_link", told, [area], [Point(), Point(x=1.0)]).markers
    assert found[0].action == Marker.DELETEALL
    assert len({one.id for one in found}) == len(found) and {one.header.frame_id for one in found} == {
        "zx200/base_link"
    }
    kinds = [one.type for one in found[1:]]
    assert kinds.count(Marker.TRIANGLE_LIST) == 1 and kinds.count(Marker.LINE_STRIP) == 1
    truck, margin = (one for one in found if one.pose.position.x == pytest.approx(8.0))
    assert (truck.scale.x, margin.scale.x, margin.color.a < 0.3 < truck.color.a) == (2.0, 3.0, True)
    assert all(min(one.scale.x, one.scale.y, one.scale.z) > 0 for one in found if one.type == Marker.CUBE and one.id)


class FakePlanner:
    """A planner that knows its scene, or not."""

    last = None

    def __init__(self, unknown: bool = False) -> None:
        self.unknown = unknown

    def pose(self) -> tuple[float, ...]:
        if self.unknown:
            raise SubtaskFailed(JointsUnheard("zx200", "/zx200/joint_states", ("boom_joint",)))
        return POSE

    def scene(self) -> Scene:
        return Scene((TRUCK,))

    def areas(self) -> list[Area]:
        return []


class Ros:
    """Keeps what is served and published."""

    def __init__(self) -> None:
        self.listeners, self.sent = 0, list[Any]()

    def publisher(self, _: Any, topic: str, depth: int) -> Any:
        assert (topic, depth) == ("/zx200/rp/scene", 1)
        return SimpleNamespace(get_subscription_count=lambda: self.listeners, publish=self.sent.append)

    def offer_slow(self, _: Any, name: str, answer: Any) -> None:
        assert name == "/zx200/rp/get_scene"
        self.answer = answer

    def poll_in_thread(self, period: float, work: Any, _: str) -> None:
        assert period >= 0.5
        self.work = work


def served(planner: FakePlanner) -> Ros:
    ros = Ros()
    site = SimpleNamespace(border=lambda _: SimpleNamespace(base_frame="zx200/base_link"))
    SceneServer(cast(Any, SimpleNamespace(ros=ros, site=site, machine="zx200")), MODEL, cast(Any, planner))
    return ros


def test_markers_are_made_only_for_listeners() -> None:
    ros = served(FakePlanner())
    ros.work()
    assert ros.sent == []
    ros.listeners = 1
    ros.work()
    assert len(ros.sent[0].markers) > len(MODEL.shapes)


def test_a_program_gets_the_scene() -> None:
    answer = served(FakePlanner()).answer(GetScene.Request(), GetScene.Response())
    assert answer.error_code == ""
    assert [one.name for one in answer.bodies] == [*(to_line(Part(link)) for link in MODEL.shapes), to_line(TRUCK.name)]
    assert isinstance(answer.bodies[0], SceneBody)


def test_why_the_scene_is_not_known_is_told() -> None:
    ros = served(FakePlanner(unknown=True))
    answer = ros.answer(GetScene.Request(), GetScene.Response())
    assert answer.error_code == "JOINTS_UNHEARD" and isinstance(of(answer.error_msg), JointsUnheard)
    ros.listeners = 1
    ros.work()
    drawn = [one.text for one in ros.sent[0].markers if one.type == Marker.TEXT_VIEW_FACING]
    assert len(drawn) == 1 and "zx200" in drawn[0]
