"""What a motion controller costs: bridge, gateway and controller as processes, with OperaSim-PhysX's stand-in."""

from __future__ import annotations

import tempfile
import time
from array import array
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import psutil
from builtin_interfaces.msg import Duration
from control_msgs.action import FollowJointTrajectory
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from conftest import claimed_domain, ports_of, rearm
from operasim_rig import LIMIT, OperaSim, operasim

MACHINE = "zx200"
MEASURED = 10.0  # s
JOINTS = ["swing_joint", "boom_joint", "arm_joint", "bucket_joint", "bucket_end_joint"]


def costs() -> tuple[float, float, float]:
    """Percent of a core: idle, moving a joint, and the gateway beside it while idle."""
    with tempfile.TemporaryDirectory() as folder, _site(Path(folder)) as site:
        controller, gateway = (site.process(f"{MACHINE}:{name}").pid for name in ("mc", "rc"))
        idle, floor = _percent(controller, gateway)
        call = _swing(site)
        site.until(lambda: abs(site.joint("swing_joint")["velocity"]) > 0.02, "it moves")
        moving, _ = _percent(controller, gateway)
        assert call.outcome is None, "it moved while that was measured"
        return idle, moving, floor


@contextmanager
def _site(folder: Path) -> Iterator[OperaSim]:
    with claimed_domain() as domain, operasim(folder, domain, ports_of(domain), MACHINE, "zx200") as site:
        site.until(site.stands, "it stands")
        site.run(f"{MACHINE}:rc", f"{MACHINE}:mc")
        site.until(lambda: rearm(site.ros, MACHINE), "it is armed")
        yield site


def _swing(site: OperaSim) -> Any:
    """A goal that lasts longer than what is measured."""
    peer = site.ros.peer(FollowJointTrajectory, f"/{MACHINE}/rc/follow_joint_trajectory")
    peer.wait_ready(LIMIT)
    joints = site.truth()["joints"]
    now = [joints[name]["position"] if joints.get(name) else 0.0 for name in JOINTS]
    point = JointTrajectoryPoint(
        positions=array("d", [now[0] + 2.0, *now[1:]]), time_from_start=Duration(sec=round(3 * MEASURED), nanosec=0)
    )
    trajectory = JointTrajectory(joint_names=JOINTS, points=[point])
    return peer.send(FollowJointTrajectory.Goal(trajectory=trajectory))


def _percent(*pids: int) -> list[float]:
    """What these processes use for a while, of one core."""
    before = [sum(psutil.Process(pid).cpu_times()[:2]) for pid in pids]
    begun = time.monotonic()
    time.sleep(MEASURED)
    passed = time.monotonic() - begun
    return [
        100 * (sum(psutil.Process(pid).cpu_times()[:2]) - used) / passed for pid, used in zip(pids, before, strict=True)
    ]
