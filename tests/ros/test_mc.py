"""A zx200 of OperaSim-PhysX moved by our controller: bridge, gateway and controller as real processes."""

from array import array
from collections.abc import Iterator
from typing import Any

import pytest
from builtin_interfaces.msg import Duration
from control_msgs.action import FollowJointTrajectory
from operasim_rig import LIMIT, OperaSim
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from conftest import rearm
from tms_ros.goals import Outcome

pytestmark = [
    pytest.mark.ros,
    pytest.mark.filterwarnings("ignore:module 'sre_:DeprecationWarning"),  # a parser that the ROS wheels bring
]
MACHINE = "zx200_8"  # a name of its own: other tests may have machines in the same domain
JOINTS = ["swing_joint", "boom_joint", "arm_joint", "bucket_joint", "bucket_end_joint"]


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory, domain: int, first_port: int) -> Iterator[OperaSim]:
    folder = tmp_path_factory.mktemp("mc")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ROS_DOMAIN_ID", str(domain))
        patch.setenv("TMS_STATE", str(folder / "state"))
        made = OperaSim(folder, domain, first_port + 64, MACHINE, "zx200")
        try:
            made.until(made.stands, "the joints are where the simulator brings them at its start")
            made.run(f"{MACHINE}:rc", f"{MACHINE}:mc")
            made.until(lambda: rearm(made.ros, MACHINE), "it is armed")
            yield made
        finally:
            made.close()


def goal(angles: dict[str, float], seconds: int) -> FollowJointTrajectory.Goal:
    point = JointTrajectoryPoint(
        positions=array("d", [angles[name] for name in JOINTS]), velocities=array("d", [0.0] * 5),
        time_from_start=Duration(sec=seconds, nanosec=0),
    )  # fmt: skip
    return FollowJointTrajectory.Goal(trajectory=JointTrajectory(joint_names=JOINTS, points=[point]))


def angles(site: OperaSim) -> dict[str, float]:
    joints = site.truth()["joints"]
    return {name: joints[name]["position"] if joints.get(name) else 0.0 for name in JOINTS}


def send(site: OperaSim, change: dict[str, float], seconds: int = 6) -> tuple[Any, Any]:
    """A goal of somebody else, through the gateway: its peer and its call."""
    peer = site.ros.peer(FollowJointTrajectory, f"/{MACHINE}/rc/follow_joint_trajectory")
    peer.wait_ready(LIMIT)
    now = angles(site)
    return peer, peer.send(goal({**now, **{name: now[name] + way for name, way in change.items()}}, seconds))


def test_a_trajectory_is_followed_through_the_gateway(site: OperaSim) -> None:
    begun = angles(site)
    _, call = send(site, {"boom_joint": 0.2, "swing_joint": 0.5})
    assert call.wait_for(lambda: call.outcome is not None, LIMIT)
    assert call.outcome is Outcome.SUCCEEDED, call.result
    now = angles(site)
    assert now["boom_joint"] - begun["boom_joint"] == pytest.approx(0.2, abs=0.03)
    assert now["swing_joint"] - begun["swing_joint"] == pytest.approx(0.5, abs=0.03)
    assert now["arm_joint"] == pytest.approx(begun["arm_joint"], abs=0.03)
