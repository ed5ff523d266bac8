"""A task as simple as the decisions need it: branches side by side, each a sequence of leaf goals."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import dataclass

from simulation.unit import SUBTASK
from tms_decision.leaf.events import Key
from tms_decision.leaf.state import GoalState, LeafGoal


@dataclass(frozen=True)
class Leaf:
    """One leaf."""

    key: Key
    seconds: float
    tries: int  # as a RetryUntilSuccessful around it has them


@dataclass(frozen=True)
class Task:
    """What a run does: for each machine a sequence."""

    branches: tuple[tuple[Leaf, ...], ...]

    def machines(self) -> list[str]:
        return [branch[0].key[1] for branch in self.branches]


def some_task(chance: random.Random, machines: list[str]) -> Task:
    """A task for these machines."""
    return Task(tuple(_branch(chance, at, machine) for at, machine in enumerate(machines)))


def _branch(chance: random.Random, at: int, machine: str) -> tuple[Leaf, ...]:
    keys = [(f"0.{at}.{i}", machine, SUBTASK, f"record{i}") for i in range(chance.randint(1, 3))]
    return tuple(
        Leaf(key, 0.8 + chance.choice((2.0, 2.0, 6.0)) * chance.random(), chance.choice((1, 1, 2))) for key in keys
    )


def beside(node: str, other: str) -> bool:
    """Whether neither node waits for the other."""
    return node.split(".")[1] != other.split(".")[1]


class Tree:
    """The tree of a run."""

    def __init__(self, task: Task, send: Callable[[Leaf], LeafGoal], cancel: Callable[[LeafGoal], None]) -> None:
        self._send, self._cancel = send, cancel
        self._branches = [_Branch(list(branch)) for branch in task.branches]

    def tick(self) -> str:
        """One tick; returns `success`, `failure` or nothing while it goes on."""
        for branch in self._branches:
            if not branch.tick(self._send):
                return "failure"
        return "success" if not any(branch.left for branch in self._branches) else ""

    def halt(self) -> None:
        for branch in self._branches:
            if branch.goal is not None and not branch.goal.state.final:
                self._cancel(branch.goal)


class _Branch:
    def __init__(self, left: list[Leaf]) -> None:
        self.left, self.goal, self._tried = left, None, 0  # type: list[Leaf], LeafGoal | None, int

    def tick(self, send: Callable[[Leaf], LeafGoal]) -> bool:
        """Go on; False when a leaf has failed."""
        while self.left:
            if self.goal is None:
                self.goal = send(self.left[0])
                self._tried += 1
            if not self.goal.state.final:
                return True
            succeeded, self.goal = self.goal.state is GoalState.SUCCEEDED, None
            if succeeded:
                self.left, self._tried = self.left[1:], 0
            elif self._tried >= self.left[0].tries:
                return False
            else:
                return True
        return True
