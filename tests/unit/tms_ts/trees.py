"""Shorthand for tree documents in tests."""

from __future__ import annotations

from typing import Any

from tms_reason.reason import Reason
from tms_ts.bt import Status, Tree, load
from unit.tms_ts.fakes import FakeWorld


def document(body: str, *others: str, model: str = "") -> str:
    trees = "".join(f'<BehaviorTree ID="T{i + 1}">{other}</BehaviorTree>' for i, other in enumerate(others))
    return f'<root main_tree_to_execute="M">\n<BehaviorTree ID="M">\n{body}\n</BehaviorTree>{trees}{model}</root>'


def tree(body: str, *others: str, fake: FakeWorld | None = None, **options: Any) -> Tree:
    return load(document(body, *others), world=(fake or FakeWorld()).world(), **options)


def leaf(record: str = "R", model: str = "Zx200") -> str:
    return f'<Action ID="LeafNode{model}" model_name="zx200" record_name="{record}" subtask_name="st_zx200_swing"/>'


def ticked(one: Tree) -> tuple[Status, Reason | None]:
    """The status of one tick, and the root's reason when it came to that; the root is IDLE and has none afterwards."""
    reasons: list[Reason | None] = [one.root.reason]
    one.observers.append(lambda node, old, new: reasons.append(node.reason) if node is one.root and new else None)
    status = one.tick()
    return status, one.root.reason or reasons[-1]
