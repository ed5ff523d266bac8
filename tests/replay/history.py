"""The history of a plan without its times and places: what a simulation and real processes must both tell.

The order counts where one thing is the cause of the next: what happens to one machine, to one run, and to those who
ask. What happens at the same time to different ones has no order.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import groupby

from replay.seen import Answer, Seen, state_of
from simulation.disk import Entry
from tms_cli.drill.record import Goal, MotionSample, Receipt, ReportedState, TrialRecording
from tms_cli.drill.verdict import FRAME, TOLERANCE
from tms_decision import reasons as d
from tms_reason import wire
from tms_reason.reason import Reason
from tms_ts import reasons as ts

# Kinds of reasons that both sides name; others are those of one machine, of a library, or of a person.
KINDS = (
    d.SoftwareStop, d.MachineLatched, d.HeldByAnother, d.DrivenByHand, d.SchedulerLost, d.ProcessLost, d.WhileMoving,
    d.NotSeenToStand, d.NoRunTold, d.PressedByOthers, d.LeftStandStill, d.SeenToStand, d.NotSeenStanding,
    ts.MachineBusy,
)  # fmt: skip
LEAVES = (d.GoalSent, d.GoalSucceeded, d.NotRepeatedDone, d.NotRepeatedFailed)
ENDED = (d.GoalCancelled, d.GoalRefused, d.GoalGaveUp, d.MachineLatched, d.ForTooLong, d.LostTimes)
LATCHED = "is latched"
Told = tuple[str, ...]


@dataclass(frozen=True)
class History:
    """What happened."""

    machines: tuple[tuple[str, Told], ...]
    runs: tuple[tuple[str, Told], ...]
    answers: Told

    def __str__(self) -> str:
        lines = [f"  {name}: {', '.join(told)}" for name, told in (*self.machines, *self.runs)]
        return "\n".join([*lines, *(f"  {answer}" for answer in self.answers)])


def history(seen: Seen) -> History:
    """The history of what was seen."""
    return History(
        tuple((name, of_machine(record)) for name, record in sorted(seen.machines.items())),
        tuple((f"run {name}", of_run(entries)) for name, entries in sorted(seen.runs.items())),
        tuple(map(_answer, seen.answers)),
    )


def kinds(reason: Reason | None) -> str:
    """What both sides tell of a reason."""
    found = [kind.code for kind in KINDS if reason is not None and reason.find(kind) is not None]
    return f" ({' '.join(found)})" if found else ""


def _answer(answer: Answer) -> str:
    return f"{answer.asked}: {'done' if answer.wrong is None else f'refused{kinds(answer.wrong)}'}"


def once(words: Iterable[str]) -> Told:
    """The same thing told several times in a row counts once: a proof, or a sending, may be repeated."""
    return tuple(word for word, _ in groupby(words))


# machines


def of_machine(record: TrialRecording) -> Told:
    """Its goals, stops with their proof and the truth about it, and whether it may move."""
    told = [(goal.began, _goal(goal)) for goal in record.goals.values()]
    told += [(one.at, _receipt(one, record)) for one in record.receipts]  # it may come later than the next goal
    told += _latches(record.states)
    return once(word for _, word in sorted(told, key=lambda one: one[0]))


def _goal(goal: Goal) -> str:
    return "moves on" if goal.ended is None else "moves and arrives" if goal.arrived else "moves and is stopped"


def _receipt(receipt: Receipt, record: TrialRecording) -> str:
    stands = stood(receipt.at, record)
    seen = "is seen to stand" if receipt.confirmed else "is not seen to stand"
    return f"{seen}, {'and stands' if stands else 'and moves'}"


def stood(at: float, record: TrialRecording) -> bool:
    """Whether it truly stood at a moment."""
    near = [one for one in record.truth if abs(one.at - at) <= FRAME] or _last_before(at, record)
    assert near, f"nothing is known of the true motion at {at}"
    return all(one.share <= TOLERANCE for one in near)


def _last_before(at: float, record: TrialRecording) -> list[MotionSample]:
    return [one for one in record.truth if one.at <= at][-1:]


def _latches(states: Sequence[ReportedState]) -> list[tuple[float, str]]:
    """Changes of the latch. A hold ends with the next goal, which is told anyway."""
    told, before = [], ""
    for state in states:
        now = f"{LATCHED}{kinds(wire.of(state.latch))}" if state.latch else _held(state, before)
        if now != before and now:
            told.append((state.at, now))
        before = now
    return told


def _held(state: ReportedState, before: str) -> str:
    if state.hold:
        return f"is held{kinds(wire.of(state.hold))}"
    return "is armed" if before.startswith(LATCHED) else ""


# runs


def of_run(entries: Sequence[Entry]) -> Told:
    """Its states, what became of the goals of its leaves, and its alarms."""
    records: dict[str, str] = {}  # by node
    for entry in entries:
        if isinstance(entry.what, d.GoalSent):
            records[entry.node] = entry.what.record
    return once(word for entry in entries if (word := _entry(entry, records.get(entry.node, ""))))


def _entry(entry: Entry, leaf: str) -> str:
    what = entry.what
    if entry.kind == "run":
        why = what.why if isinstance(what, ts.StateBecause) else None
        return f"is {state_of(entry).text}{kinds(why)}"
    if entry.kind == "loss":
        return f"{leaf} is lost"
    if entry.kind == "alarm":
        return f"alarm{kinds(what)}"
    if entry.kind != "goal":
        return ""
    return _leaf(what, leaf)


def _leaf(what: Reason, leaf: str) -> str:
    if isinstance(what, d.GoalAccepted):
        return ""
    known = next((kind.code for kind in LEAVES if isinstance(what, kind)), "")
    return f"{leaf} {known.lower()}" if known else f"{leaf} is not done"
