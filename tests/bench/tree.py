"""How long a tree of 1000 nodes takes to load and to tick, and what it weighs; the floor is a plain py_trees tree.

The tree: a Parallel of 100 branches, each a Sequence of nine leaves of which the last one stays RUNNING. The C++
library takes 0.9 ms to load it and 0.014 ms for an idle tick.
"""

from __future__ import annotations

import gc
import tracemalloc
from collections.abc import Callable, Iterable
from typing import Any

import py_trees

from bench.runner import Figure, milliseconds
from tms_decision.leaf.state import GoalState, LeafGoal
from tms_ts.bt import Status, load
from tms_ts.sent_goal import SentGoal
from unit.tms_ts.fakes import FakeMachines, FakeWorld

BRANCHES, LEAVES = 100, 9


def measure() -> Iterable[Figure]:
    text = document()
    world = FakeWorld(AtWork()).world()
    tree, plain = load(text, world=world), plain_py_trees()
    assert tree.tick() is Status.RUNNING
    plain.tick_once()
    build, loading = milliseconds(plain_py_trees, lambda: load(text, world=world), rounds=50)
    yield Figure("load", "ms", loading, 20.0, build, usual_floor=4.8)
    plain_tick, tick = milliseconds(plain.tick_once, tree.tick, rounds=2000)
    yield Figure("idle tick", "ms", tick, 0.1, plain_tick, usual_floor=0.69)
    count = len(tree.nodes)
    weight, plain_weight = weight_of(lambda: load(text, world=world)), weight_of(plain_py_trees)
    yield Figure("memory a node", "B", weight / count, 3072.0, plain_weight / count)


class AtWork(FakeMachines):
    """Machines that work for ever; their goals are those of a run."""

    def send(self, machine: str, subtask: str, record: str, node: str) -> Any:
        asked: Any = None
        goal = LeafGoal(asked, 0.0, GoalState.RUNNING)
        return SentGoal(goal, lambda: None, lambda: None)


def document() -> str:
    quick = "".join(f'<SetBlackboard output_key="k{i}" value="{i}"/>' for i in range(LEAVES - 1))
    leaf = '<Action ID="LeafNodeZx200" model_name="zx200" record_name="R" subtask_name="st_zx200_swing"/>'
    branches = f"<Sequence>{quick}{leaf}</Sequence>" * BRANCHES
    return (
        '<root main_tree_to_execute="M"><BehaviorTree ID="M"><Parallel success_threshold="-1">'
        f"{branches}</Parallel></BehaviorTree></root>"
    )


def plain_py_trees() -> py_trees.behaviour.Behaviour:
    root = py_trees.composites.Parallel("root", py_trees.common.ParallelPolicy.SuccessOnAll())
    for branch in range(BRANCHES):
        sequence = py_trees.composites.Sequence(f"s{branch}", memory=True)
        sequence.add_children([py_trees.behaviours.Success(f"{branch}.{i}") for i in range(LEAVES - 1)])
        sequence.add_child(py_trees.behaviours.Running(f"{branch}.r"))
        root.add_child(sequence)
    return root


def weight_of(make: Callable[[], object]) -> int:
    """Bytes that a made thing keeps."""
    gc.collect()
    tracemalloc.start()
    kept = make()
    gc.collect()
    weight = tracemalloc.get_traced_memory()[0]
    tracemalloc.stop()
    del kept
    return weight
