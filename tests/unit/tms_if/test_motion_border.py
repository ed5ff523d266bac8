"""Motions under the names of version 6: as far as the machine has them, with nothing lost between two types."""

import threading
from types import SimpleNamespace
from typing import Any

import pytest
from com3_msgs.action import SetSwingAngle
from geometry_msgs.msg import PoseStamped
from nav2_msgs.action import NavigateToPose
from tms_msg_rp.action import TmsRpCrawlerDumpDumpAngle, TmsRpCrawlerDumpSwingAngle, TmsRpFollowStraight

from conftest import wait_until
from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_if.motion_border import Renamed, Standing, Straight, serve
from tms_ros.goals import Outcome

NAVIGATION = {"tms_rp_navigate_anywhere", "tms_rp_navigate_follow_straight", "tms_rp_navigate_through_poses",
              "tms_rp_navigate_follow_waypoints"}  # fmt: skip


@pytest.mark.parametrize(
    ("model", "further"),
    [
        ("zx200", set()),
        ("d37pxi", {"tms_rp_set_bulldozer_blade"}),
        ("ic120", {"tms_rp_set_dump_angle"}),
        ("mst110cr", {"tms_rp_set_dump_angle", "tms_rp_set_swing_angle", "tms_rp_set_swing_angle_align_to_heading"}),
    ],
)
def test_a_machine_has_the_names_of_its_motions(model: str, further: set[str]) -> None:
    border = parse(CONFIGS / "machines" / f"{model}.yaml", MachineModel).borders["sim"]
    served: dict[str, Any] = {}
    sent: dict[str, str] = {}

    def peer(kind: Any, name: str) -> Any:
        return SimpleNamespace(kind=kind, name=name)

    def take(kind: Any, name: str, run: Any, accept: Any) -> None:
        served[name.removeprefix("/m/")] = kind
        sent[name.removeprefix("/m/")] = accept.__self__._peer.name

    app: Any = SimpleNamespace(
        machine="m", site=SimpleNamespace(border=lambda _: border), pulse=None,
        ros=SimpleNamespace(peer=peer, serve=take, lease_publisher=lambda *_: None),
    )  # fmt: skip
    serve(app)
    assert set(served) == NAVIGATION | further
    assert served["tms_rp_navigate_follow_straight"] is TmsRpFollowStraight
    assert all(name.startswith("/m/rc/") for name in sent.values())
    if "tms_rp_set_dump_angle" in further:
        assert served["tms_rp_set_dump_angle"] is TmsRpCrawlerDumpDumpAngle


class Noted:
    """A permit that notes what it stands behind; None: nothing."""

    def __init__(self) -> None:
        self.behind: list[bytes | None] = []

    def hold(self, goal: bytes) -> None:
        self.behind.append(goal)

    def drop(self) -> None:
        self.behind.append(None)


def test_the_border_stands_behind_the_oldest_open_goal() -> None:
    permit: Any = Noted()
    standing = Standing(permit)

    def run(goal: Any) -> Any:
        return [standing.behind(step)(SimpleNamespace(uuid=name)) for name, step in goal.further]

    def fails(goal: Any) -> Any:
        raise RuntimeError

    first: Any = SimpleNamespace(uuid=b"1", further=[(b"2", lambda _: None)])  # a second goal comes and goes meanwhile
    standing.behind(run)(first)
    assert permit.behind == [b"1", None]
    with pytest.raises(RuntimeError):
        standing.behind(fails)(first)
    assert permit.behind == [b"1", None, b"1", None]


def test_the_next_goal_is_stood_behind_when_the_oldest_has_ended() -> None:
    permit: Any = Noted()
    standing, over = Standing(permit), {b"1": threading.Event(), b"2": threading.Event()}
    workers = []
    for name in over:
        goal: Any = SimpleNamespace(uuid=name)
        run: Any = standing.behind(lambda one: over[one.uuid].wait(60))
        workers.append(threading.Thread(target=run, args=(goal,)))
        workers[-1].start()
        wait_until(lambda: len(standing._open) == len(workers), 60, "the goal is under way")
    for (_, event), worker in zip(over.items(), workers, strict=True):
        event.set()
        worker.join()
    assert permit.behind == [b"1", b"2", None]


def test_an_angle_reaches_the_machine_and_its_end_the_client() -> None:
    peer: Any = None
    relay = Renamed("m", TmsRpCrawlerDumpSwingAngle, peer, SetSwingAngle)
    asked = relay.request(TmsRpCrawlerDumpSwingAngle.Goal(target_angle=0.5))
    assert asked == SetSwingAngle.Goal(target_angle=0.5)
    told = relay.feedback(SetSwingAngle.Feedback(current_error=0.25))
    assert told == TmsRpCrawlerDumpSwingAngle.Feedback(current_error=0.25)
    done = relay.result(Outcome.SUCCEEDED, SetSwingAngle.Result(success=True))
    assert done == TmsRpCrawlerDumpSwingAngle.Result(success=True)
    assert not relay.result(Outcome.ABORTED, None).success  # its server is lost


def test_straight_on_is_a_drive_to_the_pose() -> None:
    peer: Any = None
    relay, pose = Straight("m", TmsRpFollowStraight, peer, NavigateToPose), PoseStamped()
    pose.header.frame_id, pose.pose.position.x = "map", 3.0
    assert relay.request(TmsRpFollowStraight.Goal(pose=pose)) == NavigateToPose.Goal(pose=pose)
    assert relay.feedback(NavigateToPose.Feedback()).running
    assert relay.result(Outcome.SUCCEEDED, NavigateToPose.Result()).result
    assert not relay.result(Outcome.CANCELED, NavigateToPose.Result()).result
