"""A zx200 of OperaSim-PhysX moved by our controller: bridge, gateway and controller as real processes."""

import math
from collections.abc import Iterator
from typing import Any

import pytest
from com3_msgs.msg import JointCmd
from geometry_msgs.msg import PoseStamped
from nav2_msgs.action import ComputePathToPose, FollowPath, NavigateToPose
from nav_msgs.msg import Path
from tms_msg_db.srv import GetParameter
from tms_msg_rc.msg import StopReceipt
from tms_msg_rc.srv import StopMachine

from mc_rig import angles, armed, begin, ended, moving, send
from operasim_rig import LIMIT, OperaSim, operasim
from tms_control.reasons import GoalTaken
from tms_machine.border import PLAN
from tms_machine.values import Value, to_parameters
from tms_reason import wire
from tms_ros.goals import Outcome

pytestmark = [
    pytest.mark.turns,
    pytest.mark.ros,
    pytest.mark.filterwarnings("ignore:module 'sre_:DeprecationWarning"),  # a parser that the ROS wheels bring
]
MACHINE = "zx200_8"  # a name of its own: other tests may have machines in the same domain


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory, domain: int, first_port: int) -> Iterator[OperaSim]:
    with operasim(tmp_path_factory.mktemp("mc"), domain, first_port + 64, MACHINE, "zx200") as made:
        begin(made)
        yield made


def test_a_trajectory_is_followed_through_the_gateway(site: OperaSim) -> None:
    begun = angles(site)
    _, call = send(site, {"boom_joint": 0.2, "swing_joint": 0.5})
    assert ended(site, call) is Outcome.SUCCEEDED, call.result
    now = angles(site)
    assert now["boom_joint"] - begun["boom_joint"] == pytest.approx(0.2, abs=0.03)
    assert now["swing_joint"] - begun["swing_joint"] == pytest.approx(0.5, abs=0.03)
    assert now["arm_joint"] == pytest.approx(begun["arm_joint"], abs=0.03)


def ahead(site: OperaSim, way: float) -> PoseStamped:
    """The pose some metres ahead of the machine."""
    place, yaw = site.truth()["place"], site.truth()["yaw"]
    pose = PoseStamped()
    pose.header.frame_id = "map"
    pose.pose.position.x, pose.pose.position.y = place[0] + way * math.cos(yaw), place[1] + way * math.sin(yaw)
    pose.pose.orientation.z, pose.pose.orientation.w = math.sin(yaw / 2), math.cos(yaw / 2)
    return pose


def done(site: OperaSim, kind: Any, action: str, goal: Any) -> Any:
    """The result of a goal that must succeed."""
    peer = site.ros.peer(kind, f"/{MACHINE}/{action}")
    peer.wait_ready(LIMIT)
    call = peer.send(goal)
    assert ended(site, call) is Outcome.SUCCEEDED, call.result
    return call.result


def stands_at(site: OperaSim, pose: PoseStamped) -> bool:
    off = math.dist(site.truth()["place"][:2], (pose.pose.position.x, pose.pose.position.y))
    return off <= 0.3 and site.truth()["tracks"] == {"left": 0.0, "right": 0.0}


def test_a_pose_is_driven_to_through_the_gateway(site: OperaSim) -> None:
    pose, told = ahead(site, 2.0), site.hear(Path, PLAN)
    done(site, NavigateToPose, "rc/navigate_to_pose", NavigateToPose.Goal(pose=pose))
    assert stands_at(site, pose)
    end = told[0].poses[-1].pose.position
    assert (end.x, end.y) == pytest.approx((pose.pose.position.x, pose.pose.position.y), abs=0.1)


def test_a_path_is_planned_without_the_gateway_and_followed_through_it(site: OperaSim) -> None:
    here, pose = ahead(site, 0.0), ahead(site, -2.0)
    path: Path = done(site, ComputePathToPose, "compute_path_to_pose", ComputePathToPose.Goal(goal=pose)).path
    first, last = path.poses[0].pose.position, path.poses[-1].pose.position
    assert (first.x, first.y) == pytest.approx((here.pose.position.x, here.pose.position.y), abs=0.1)
    assert (last.x, last.y) == pytest.approx((pose.pose.position.x, pose.pose.position.y), abs=0.01)
    assert stands_at(site, here), "planning has moved nothing"
    done(site, FollowPath, "rc/follow_path", FollowPath.Goal(path=path))
    assert stands_at(site, pose)


def beside(site: OperaSim, way: float, left: float) -> tuple[float, float]:
    """The place some metres ahead and to the left of the machine."""
    at, turned = ahead(site, way).pose, math.tau / 4 + site.truth()["yaw"]
    return at.position.x + left * math.cos(turned), at.position.y + left * math.sin(turned)


def path_to(site: OperaSim, pose: PoseStamped) -> list[tuple[float, float]]:
    path: Path = done(site, ComputePathToPose, "compute_path_to_pose", ComputePathToPose.Goal(goal=pose)).path
    return [(at.pose.position.x, at.pose.position.y) for at in path.poses]


def test_a_path_leads_along_a_road_and_around_a_blocked_area_and_no_goal_into_it(site: OperaSim) -> None:
    pit = [beside(site, *corner) for corner in ((8.0, -1.0), (9.0, -1.0), (9.0, 1.0), (8.0, 1.0))]
    road = [beside(site, 2.0, 4.0), beside(site, 15.0, 4.0)]
    x, y = (list(one) for one in zip(*road, strict=True))
    records: dict[str, dict[str, Value]] = {"roads": {"haul": ["section"]}, "section": {"x": x, "y": y}}

    def answer(request: GetParameter.Request, response: GetParameter.Response) -> GetParameter.Response:
        if request.record_name in records:
            response.record.values = to_parameters(records[request.record_name])
        else:
            response.error_code = "RECORD_MISSING"
        return response

    site.ros.offer(GetParameter, "/tms/db/get_parameter", answer)
    here, pose = ahead(site, 0.0), ahead(site, 17.0)
    along = path_to(site, pose)
    assert all(min(math.dist(at, place) for at in along) < 0.2 for place in road)
    records["blocked_areas"] = {"pit": [one for corner in pit for one in corner]}
    middle = tuple(sum(one) / 4 for one in zip(*pit, strict=True))
    assert min(math.dist(at, middle) for at in path_to(site, pose)) > 3.0
    in_it = PoseStamped()
    in_it.header.frame_id, in_it.pose.orientation.w = "map", 1.0
    in_it.pose.position.x, in_it.pose.position.y = middle
    peer = site.ros.peer(NavigateToPose, f"/{MACHINE}/rc/navigate_to_pose")
    peer.wait_ready(LIMIT)
    call = peer.send(NavigateToPose.Goal(pose=in_it))
    assert ended(site, call) is Outcome.ABORTED
    why = wire.of(call.result.error_msg)
    assert why is not None and why.find(GoalTaken) is not None
    assert stands_at(site, here), "a goal in the area has moved nothing"


def test_a_cancelled_goal_leaves_the_joints_to_the_gateway(site: OperaSim) -> None:
    peer, call = send(site, {"swing_joint": -1.0}, 8)
    moving(site, "swing_joint")
    peer.cancel(call)
    assert ended(site, call) is Outcome.CANCELED, call.result
    site.until(site.stands, "it stands")
    heard: list[JointCmd] = site.hear(JointCmd, "front_cmd")
    stood = angles(site)
    _, call = send(site, {"bucket_joint": 0.2})
    assert ended(site, call) is Outcome.SUCCEEDED, call.result
    assert heard, "our controller sends again"
    assert site.joint("swing_joint")["position"] == pytest.approx(stood["swing_joint"], abs=0.03)
    assert site.joint("bucket_joint")["position"] == pytest.approx(stood["bucket_joint"] + 0.2, abs=0.03)


def test_a_stop_presses_and_a_rearm_releases_without_a_jump(site: OperaSim) -> None:
    _, call = send(site, {"swing_joint": 1.0}, 8)
    moving(site, "swing_joint")
    site.ros.call(StopMachine, f"/{MACHINE}/rc/stop", StopMachine.Request(cause="a test"), LIMIT)
    assert ended(site, call) is Outcome.ABORTED
    site.until(lambda: site.truth()["stopped"], "its emergency stop is pressed")
    site.until(site.stands, "it stands")
    stood = angles(site)
    armed(site)
    site.until(lambda: not site.truth()["stopped"], "its emergency stop is released")
    _, call = send(site, {"bucket_joint": -0.2})
    assert ended(site, call) is Outcome.SUCCEEDED, call.result
    assert site.joint("swing_joint")["position"] == pytest.approx(stood["swing_joint"], abs=0.03)


def test_without_its_controller_a_goal_ends_and_the_machine_is_stopped(site: OperaSim) -> None:
    _, call = send(site, {"swing_joint": -1.0}, 8)
    moving(site, "swing_joint")
    receipts: list[StopReceipt] = site.hear(StopReceipt, "rc/receipts")
    site.kill(f"{MACHINE}:mc")
    assert ended(site, call) is Outcome.ABORTED
    site.until(lambda: receipts, "the receipt of its stop")
    assert receipts[-1].confirmed
    site.until(site.stands, "it stands")
    site.run(f"{MACHINE}:mc")
    armed(site)
    _, call = send(site, {"bucket_joint": 0.2})
    assert ended(site, call) is Outcome.SUCCEEDED, call.result


def test_without_the_gateway_the_controller_ramps_down_and_holds(site: OperaSim) -> None:
    send(site, {"swing_joint": 1.0}, 8)
    moving(site, "swing_joint")
    site.kill(f"{MACHINE}:rc")
    site.until(site.stands, "it stands")
    site.run(f"{MACHINE}:rc")
    armed(site)
