"""What tests of a motion controller on OperaSim do: arm its machine, send goals, wait for their ends."""

from array import array
from typing import Any

from builtin_interfaces.msg import Duration
from control_msgs.action import FollowJointTrajectory
from tms_msg_rc.msg import MachineState
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from conftest import rearm
from operasim_rig import LIMIT, OperaSim
from tms_ros.goals import Outcome

JOINTS = ["swing_joint", "boom_joint", "arm_joint", "bucket_joint", "bucket_end_joint"]


def armed(site: OperaSim) -> None:
    """Re-arm the machine, once its gateway lives: a killed one stays in the graph for a while."""
    states: list[MachineState] = site.hear(MachineState, "rc/state")
    site.until(lambda: states, "its gateway")
    site.until(lambda: rearm(site.ros, site.machine), f"{site.machine} is armed")


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
    peer = site.ros.peer(FollowJointTrajectory, f"/{site.machine}/rc/follow_joint_trajectory")
    peer.wait_ready(LIMIT)
    now = angles(site)
    return peer, peer.send(goal({**now, **{name: now[name] + way for name, way in change.items()}}, seconds))


def ended(site: OperaSim, call: Any) -> Any:
    site.until(lambda: call.outcome is not None, "the end of the goal")
    return call.outcome


def moving(site: OperaSim, joint: str) -> None:
    site.until(lambda: abs(site.joint(joint)["velocity"]) > 0.05, f"{joint} moves")


def taken(site: OperaSim) -> None:
    """Wait until the gateway takes goals: at its start it first proves that the machine stands, for some seconds.

    The release of its stop falls into that time, which may latch the machine once more.
    """

    def succeeds() -> bool:
        if not rearm(site.ros, site.machine):
            return False
        _, call = send(site, {}, 1)
        return bool(ended(site, call) is Outcome.SUCCEEDED)

    site.until(succeeds, "a goal that moves nothing succeeds")


def begin(site: OperaSim) -> None:
    """Start gateway and controller of the machine, once it stands, and wait until they take goals."""
    site.until(site.stands, "the joints are where the simulator brings them at its start")
    site.run(f"{site.machine}:rc", f"{site.machine}:mc")
    armed(site)
    taken(site)
