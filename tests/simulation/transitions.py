"""The state machines as pictures: their states are those of the code, their transitions those that happen in schedules.

`python -m simulation.transitions` writes them into ARCHITECTURE.md.
"""

import re
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import click
import pytest

from simulation import gateway as process
from simulation.schedule import Schedule
from tms_decision.gateway import active
from tms_decision.gateway.state import Gateway, Goal
from tms_decision.gateway.state import Phase as GoalPhase
from tms_decision.gateway.step import step
from tms_decision.leaf.state import GoalState, LeafGoal
from tms_decision.run.step import Phase as RunPhase
from tms_decision.run.step import Run

Arrow = tuple[str, str, str]  # machine, from, to
SEEDS = range(80)
PAGE = Path(__file__).parents[2] / "ARCHITECTURE.md"
LATCH = {
    "ARMED": "goals may move the machine",
    "HELD": "only the run that has lost a process may move it",
    "LATCHED": "stopped until a person re-arms it",
}
STATES: dict[str, dict[str, str]] = {
    "goal": {phase.name: phase.value for phase in GoalPhase} | {"OVER": "has its answer"},
    "latch": LATCH,
    "run": {phase.name: phase.value for phase in RunPhase},
    "leaf": {state.name: state.value for state in GoalState},
}
TITLES = {
    "goal": "A goal in the gateway",
    "latch": "The latch of a machine",
    "run": "A run",
    "leaf": "The goal of a leaf in the scheduler",
}


def latch_of(gateway: Gateway) -> str:
    """The state of a latch."""
    latch = gateway.latch
    return "LATCHED" if latch.cause is not None else "HELD" if latch.held is not None else "ARMED"


@contextmanager
def watched(seen: Callable[[Arrow], None]) -> Iterator[None]:
    """Tell each transition that happens meanwhile."""
    enter, run_enter, finish = Goal.enter, Run.enter, active._finish

    def goal_enters(goal: Goal, phase: GoalPhase, now: float) -> None:
        seen(("goal", goal.phase.name, phase.name))
        enter(goal, phase, now)

    def run_enters(run: Run, phase: RunPhase, now: float, *effects: Any) -> None:
        seen(("run", run.phase.name, phase.name))
        run_enter(run, phase, now, *effects)

    def goal_ends(gateway: Gateway, now: float, goal: Goal, *words: Any) -> None:
        seen(("goal", goal.phase.name, "OVER"))
        finish(gateway, now, goal, *words)

    def steps(gateway: Gateway, event: Any, now: float) -> Any:
        before, waiting = latch_of(gateway), {goal.number: goal.phase.name for goal in gateway.waiting}
        effects = step(gateway, event, now)
        left = waiting.keys() - {goal.number for goal in gateway.goals()}
        for number in left if gateway.last[0] is None or gateway.last[0].number not in left else ():
            seen(("goal", waiting[number], "OVER"))
        if latch_of(gateway) != before:
            seen(("latch", before, latch_of(gateway)))
        return effects

    def leaf_changes(goal: LeafGoal, name: str, value: Any) -> None:
        if name == "state" and getattr(goal, "state", value) is not value:
            seen(("leaf", goal.state.name, value.name))
        object.__setattr__(goal, name, value)

    with pytest.MonkeyPatch.context() as patched:
        for owner, name, own in (
            (Goal, "enter", goal_enters), (Run, "enter", run_enters), (active, "_finish", goal_ends),
            (process, "step", steps), (LeafGoal, "__setattr__", leaf_changes),
        ):  # fmt: skip
            patched.setattr(owner, name, own)
        yield


def observed(seeds: Iterable[int]) -> set[Arrow]:
    """The transitions of some schedules."""
    found = set[Arrow]()
    with watched(found.add):
        for seed in seeds:
            Schedule(seed).run()
    return found


def picture(machine: str, arrows: Iterable[Arrow]) -> str:
    """A state diagram in Mermaid, which code hosts draw."""
    lines = ["```mermaid", "stateDiagram-v2"]
    lines += [f"    {name}: {name} ({meaning})" for name, meaning in STATES[machine].items()]
    first = next(iter(STATES[machine]))
    lines += [f"    [*] --> {first}"]
    lines += [f"    {one} --> {other}" for which, one, other in sorted(arrows) if which == machine]
    return "\n".join([*lines, "```"])


def drawn(text: str) -> set[Arrow]:
    """The transitions in a page."""
    found = set[Arrow]()
    for machine, body in re.findall(r"<!-- states: (\w+) -->\n(.*?)<!-- end -->", text, re.DOTALL):
        found |= {(machine, one, other) for one, other in re.findall(r"^ +(\w+) --> (\w+)$", body, re.MULTILINE)}
    return found


def page(text: str, arrows: set[Arrow]) -> str:
    """The page with these transitions in its pictures."""
    for machine in STATES:
        body = f"<!-- states: {machine} -->\n**{TITLES[machine]}**\n\n{picture(machine, arrows)}\n<!-- end -->"
        place = re.compile(rf"<!-- states: {machine} -->.*?<!-- end -->", re.DOTALL)
        text = place.sub(body, text)
    return text


@click.command()
def main() -> None:
    """Draw the state machines into ARCHITECTURE.md, as they are seen in a thousand schedules."""
    PAGE.write_text(page(PAGE.read_text(encoding="utf-8"), observed(range(1000))), encoding="utf-8")


if __name__ == "__main__":
    main()
