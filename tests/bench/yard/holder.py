"""A scheduler and its subtasks in one process that can be killed: stands behind one goal of every machine."""

from __future__ import annotations

import sys
import time
from pathlib import Path

TESTS = Path(__file__).resolve().parents[2]
sys.path[0:1] = [str(TESTS), str(TESTS.parent / "services")]

from control_msgs.action import FollowJointTrajectory  # noqa: E402

from bench.yard.machines import LIMIT, MODEL, motion, names  # noqa: E402
from tms_config.config import load_site  # noqa: E402
from tms_decision.owner import Owner  # noqa: E402
from tms_machine.permit import Permit  # noqa: E402
from tms_ros.client import Call  # noqa: E402
from tms_ros.node import Ros  # noqa: E402
from tms_runtime.fence import goal_id  # noqa: E402
from tms_runtime.pulse import Pulse  # noqa: E402

AGAIN = 0.5  # s between looks for refused goals: with busy cores not everybody has found everybody yet


def main(run: int) -> None:
    site, ros = load_site(), Ros("bench_holder")
    peers = {name: ros.peer(FollowJointTrajectory, f"/{name}/rc/follow_joint_trajectory") for name in names()}
    subtask = next(iter(site.models[MODEL].subtasks))
    pulse = Pulse(ros)
    permits = {name: Permit(ros, pulse, name, subtask) for name in names()}
    for name in names():
        Permit(ros, pulse, name, "ts").hold(goal_id(Owner(run)), "bench")
    calls: dict[str, Call] = {}
    deadline = time.monotonic() + 10 * LIMIT
    leaf = 0
    while time.monotonic() < deadline:
        for name, peer in peers.items():
            if name not in calls or calls[name].outcome is not None:
                leaf += 1
                permits[name].hold(goal_id(Owner(run, leaf)))
                peer.wait_ready(LIMIT)
                calls[name] = peer.send(motion(site.models[MODEL]), goal_id=goal_id(Owner(run, leaf, 1)))
        time.sleep(AGAIN)


main(int(sys.argv[1]))
