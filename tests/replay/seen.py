"""What was seen of a plan, in the simulation as on real processes, and which act is due by it."""

from collections import Counter
from dataclasses import dataclass, field

from replay import acts as a
from simulation.disk import Entry
from tms_cli.drill.record import TrialRecording
from tms_reason.reason import Reason
from tms_ts import reasons as ts
from tms_ts.reasons import StateBecause

SETTLED = 2.0  # s after the last moment of a plan in which nothing may happen any more
LIMIT = 40.0  # s for a moment to come
MOVES = 1.5  # times the speed at which a machine counts as standing
ENDS = (
    ts.StateSuccess, ts.StateFailure, ts.StateCancelled, ts.StateStopUnconfirmed, ts.StateInterrupted, ts.StateRefused,
)  # fmt: skip


@dataclass
class Answer:
    """What somebody who asked was told."""

    asked: str
    wrong: Reason | None


@dataclass
class Seen:
    """Everything; times are those of the one who has seen it."""

    machines: dict[str, TrialRecording] = field(default_factory=dict)
    runs: dict[str, list[Entry]] = field(default_factory=dict)
    answers: list[Answer] = field(default_factory=list)


def state_of(entry: Entry) -> Reason:
    """The state that a run has entered."""
    return entry.what.state if isinstance(entry.what, StateBecause) else entry.what


def ends(entries: list[Entry]) -> int:
    """How often a run has ended or was interrupted."""
    return sum(entry.kind == "run" and isinstance(state_of(entry), ENDS) for entry in entries)


class Late(AssertionError):
    """A moment of a plan does not come."""


class Player:
    """Says which act of a plan is due."""

    def __init__(self, plan: a.Plan, now: float) -> None:
        self._plan, self._left = plan, list(plan.steps)
        self._last = now  # when the last act was done
        self._came: float | None = None  # when the present moment came
        self._begun: Counter[str] = Counter()
        self._asked = 0
        self.over = False

    def due(self, seen: Seen, now: float) -> a.Act | None:
        """The act to do now, if any.

        Raises:
            Late: its moment does not come.
        """
        if self._came is None:
            self._came = now if self._has_come(self._moment(), seen) else None
        if self._came is None:
            if now - self._last > LIMIT:
                raise Late(f"{self._plan.name}: {self._moment()} does not come within {LIMIT} s")
            return None
        if not self._left:
            self.over = now - self._came >= SETTLED
            return None
        if now - self._came < self._left[0].seconds:
            return None
        return self._next(now)

    def _moment(self) -> a.Moment:
        return self._left[0].moment if self._left else self._plan.end

    def _next(self, now: float) -> a.Act:
        act = self._left.pop(0).act
        self._last, self._came = now, None
        if isinstance(act, a.Start | a.Resume):
            self._begun[act.run] += 1
        self._asked += isinstance(act, a.Question)
        return act

    def _has_come(self, moment: a.Moment, seen: Seen) -> bool:
        match moment:
            case a.AtOnce():
                return True
            case a.Moves(machine, goal):
                return _moves(seen.machines[machine], goal)
            case a.Over(run):
                return ends(seen.runs.get(run, [])) >= self._begun[run]
            case a.Answered():
                return len(seen.answers) >= self._asked


def _moves(record: TrialRecording, number: int) -> bool:
    goals = sorted(record.goals.values(), key=lambda goal: goal.began)
    if len(goals) < number or goals[number - 1].ended is not None:
        return False
    return bool(record.truth) and record.truth[-1].at > goals[number - 1].began and record.truth[-1].share > MOVES
