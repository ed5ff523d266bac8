"""From the result of one leaf to the accepted goal of the next, and on to the machine's controller.

An observer in this process listens to the status topics of the subtask and of the controller, so nothing in the chain
knows that it is measured. The floor is a goal and its result between two bare rclpy processes. The note of the chain is
what bare processes need for as many hops, the first of which reads a record, as a subtask does.
"""

from __future__ import annotations

import time
from collections.abc import Iterable
from contextlib import ExitStack
from itertools import pairwise
from pathlib import Path

import yaml
from action_msgs.msg import GoalStatus, GoalStatusArray

from bench.rig.mesh import Rig, at, rig
from bench.runner import Figure
from tms_ros.node import Ros

LEAVES = 60
HOPS = [f"/bare/link_{number}" for number in range(4)]  # subtask, planner, gateway, controller
SUBTASK = "/zx200/subtask_zx200_change_pose"
CONTROLLER = "/zx200/upper_arm_controller/follow_joint_trajectory"
POSE = {"boom_joint": -0.9, "arm_joint": 2.0, "bucket_joint": 0.5, "bucket_end_joint": 0.0}
LEAF = '<Action ID="LeafNodeZx200" model_name="zx200" record_name="{}" subtask_name="subtask_zx200_change_pose"/>'
TREE = (
    '<root main_tree_to_execute="M"><BehaviorTree ID="M">'
    f'<Repeat num_cycles="{LEAVES // 2}"><Sequence>{LEAF.format("BENCH_A")}{LEAF.format("BENCH_B")}</Sequence></Repeat>'
    "</BehaviorTree></root>"
)
ENDED = (GoalStatus.STATUS_SUCCEEDED, GoalStatus.STATUS_ABORTED, GoalStatus.STATUS_CANCELED)


class Watch:
    """When each goal of one action was first seen accepted, and ended."""

    def __init__(self, ros: Ros, action: str) -> None:
        self.accepted: dict[bytes, float] = {}
        self.ended: dict[bytes, float] = {}
        ros.subscribe(GoalStatusArray, f"{action}/_action/status", self._received, depth=100, latched=True)

    def _received(self, message: GoalStatusArray) -> None:
        now = time.perf_counter()
        for each in message.status_list:
            goal = bytes(each.goal_info.goal_id.uuid)
            self.accepted.setdefault(goal, now)
            if each.status in ENDED:
                self.ended.setdefault(goal, now)


def measure() -> Iterable[Figure]:
    with rig(sim={"speed": 20.0}) as own:
        own.mesh.tms("up")
        own.mesh.arm()
        _prepare(own)
        before, hops = _bare(own)
        with own.node() as ros:
            leaves, controller = Watch(ros, SUBTASK), Watch(ros, CONTROLLER)
            own.mesh.tms("run", "1", "--wait", limit=180)
        after, hops_after = _bare(own)
    floor, hops = sorted(before + after), sorted(hops + hops_after)
    ends, starts, moves = (sorted(found.values()) for found in (leaves.ended, leaves.accepted, controller.accepted))
    assert len(ends) == len(starts) == LEAVES, f"{len(starts)} goals accepted, {len(ends)} ended, {LEAVES} wanted"
    over, chain = _gaps(ends, starts), _gaps(ends, moves)
    raw = at(0.5, floor)
    yield Figure("hand-over p50", "ms", at(0.5, over), 2 * raw, raw)
    yield Figure("hand-over p99", "ms", at(0.99, over), 3 * at(0.99, floor), at(0.99, floor))
    yield Figure("chain p50", "ms", at(0.5, chain), 5 * raw, raw, note=f"bare hops alone {at(0.5, hops):.1f} ms")


def _bare(own: Rig) -> tuple[list[float], list[float]]:
    """Milliseconds of goals between two bare processes, and of chains; before and after, since a PC's speed drifts."""
    with own.beside("serve"):
        goals = own.bare("act", "300")
        with ExitStack() as stack:
            for name, following in pairwise([*HOPS, ""]):
                stack.enter_context(own.beside("link", name, following))
            return goals, own.bare("chain", "100", HOPS[0], HOPS[-1])


def _prepare(own: Rig) -> None:
    folder = Path(own.mesh.state)
    rows = [
        {"model_name": "zx200", "record_name": name, "type": "static", "description": "", "trajectory": 1,
         "swing_joint": swing, **POSE}
        for name, swing in (("BENCH_A", 0.0), ("BENCH_B", 0.05))
    ]  # fmt: skip
    (folder / "bench.yaml").write_text(yaml.safe_dump(rows))
    (folder / "bench.xml").write_text(TREE)
    own.mesh.tms("param", "load", str(folder / "bench.yaml"))
    own.mesh.tms("task", "add", str(folder / "bench.xml"))


def _gaps(ends: list[float], starts: list[float]) -> list[float]:
    """Milliseconds from each end to the first start after it; the last end has none."""
    return sorted((next(start for start in starts if start > end) - end) * 1000 for end in ends[:-1])
