"""What Groot showed of a run: changes of nodes, and whether they came in the order of the tree."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

GREY, ORANGE, GREEN, RED = range(4)  # Groot's colours of IDLE, RUNNING, SUCCESS, FAILURE
NAMES = ("grey", "orange", "green", "red")


@dataclass(frozen=True)
class Change:
    """A node takes another colour. Times are s since 1970: of the scheduler, and of the arrival."""

    node: str
    old: int
    new: int
    stamp: float
    seen: float


@dataclass(frozen=True)
class Shape:
    """Nodes of a tree from its root, each before its children; a leaf is named by its record."""

    parents: dict[str, str]  # "" of the root

    @property
    def leaves(self) -> list[str]:
        return [name for name in self.parents if name not in self.parents.values()]

    def above(self, node: str) -> list[str]:
        """A node and what is above it, the root last."""
        found = []
        while node:
            found.append(node)
            node = self.parents[node]
        return found


def of(changes: Sequence[Change], node: str) -> list[int]:
    """The colours of a node, from its first."""
    own = [change for change in changes if change.node == node]
    return [change.old for change in own[:1]] + [change.new for change in own]


def told(colours: Sequence[int]) -> str:
    return ", ".join(NAMES[colour] for colour in colours) or "none"


def wrong_of_success(changes: Sequence[Change], shape: Shape) -> list[str]:
    """What is wrong with the colours of a run that succeeded: each node grey, orange, green, leaves one by one."""
    wanted = [GREY, ORANGE, GREEN]
    wrong = [f"{node}: {told(of(changes, node))}" for node in shape.parents if of(changes, node)[:3] != wanted]
    begun = [change.node for change in changes if change.new == ORANGE]
    if begun != list(shape.parents):
        wrong.append(f"orange in the order {', '.join(begun)}")
    at = {(change.node, change.new): number for number, change in reversed(list(enumerate(changes)))}
    for first, second in zip(shape.leaves, shape.leaves[1:], strict=False):
        if at.get((second, ORANGE), -1) < at.get((first, GREEN), len(changes)):
            wrong.append(f"{second} was orange before {first} was green")
    for node, parent in shape.parents.items():
        if parent and at.get((parent, GREEN), -1) < at.get((node, GREEN), len(changes)):
            wrong.append(f"{parent} was green before {node}")
    return wrong


def wrong_of_failure(changes: Sequence[Change], shape: Shape, failed: str) -> list[str]:
    """What is wrong with the colours of a run in which a leaf failed: it and all above it red, later leaves grey."""
    above = shape.above(failed)
    wrong = [f"{node}: {told(of(changes, node))}" for node in above if of(changes, node)[:3] != [GREY, ORANGE, RED]]
    return wrong + _begun_later(changes, shape, failed)


def wrong_of_halt(changes: Sequence[Change], shape: Shape, working: str) -> list[str]:
    """What is wrong with the colours of a run that was stopped while a leaf worked: nothing stays orange."""
    above = shape.above(working)
    wrong = [f"{node}: {told(of(changes, node))}" for node in above if ORANGE in of(changes, node)[-1:]]
    wrong += [f"{node} was green" for node in above if GREEN in of(changes, node)]
    return wrong + _begun_later(changes, shape, working)


def _begun_later(changes: Sequence[Change], shape: Shape, last: str) -> list[str]:
    later = shape.leaves[shape.leaves.index(last) + 1 :]
    return [f"{node} began after {last}" for node in later if of(changes, node)]
