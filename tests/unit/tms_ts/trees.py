"""Shorthand for tree documents in tests."""

from __future__ import annotations

from typing import Any

from tms_ts.bt import Tree, load
from unit.tms_ts.fakes import FakeWorld


def document(body: str, *others: str, model: str = "") -> str:
    trees = "".join(f'<BehaviorTree ID="T{i + 1}">{other}</BehaviorTree>' for i, other in enumerate(others))
    return f'<root main_tree_to_execute="M">\n<BehaviorTree ID="M">\n{body}\n</BehaviorTree>{trees}{model}</root>'


def tree(body: str, *others: str, fake: FakeWorld | None = None, **options: Any) -> Tree:
    return load(document(body, *others), world=(fake or FakeWorld()).world(), **options)


def leaf(record: str = "R", model: str = "Zx200") -> str:
    return f'<Action ID="LeafNode{model}" model_name="zx200" record_name="{record}" subtask_name="st_zx200_swing"/>'
