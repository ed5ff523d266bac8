"""Compares the receipts of a stop with the true motion. Pure logic; all times are s since 1970."""

import math
from bisect import bisect_right
from dataclasses import asdict, dataclass, field
from itertools import pairwise
from typing import Any

from tms_cli.drill.plan import IN_ORDER, NONE, RC, How, Trial
from tms_cli.drill.record import MotionSample, Receipt, TrialRecording
from tms_cli.words import english

TOLERANCE = 1.1  # times the limit of standing: the true motion is sampled and not rounded
FRAME = 0.02  # s, half of the time between samples of the truth
CLAIMED = 0.2  # s of standing that a receipt claims
LATENCY = 0.1  # s before a receipt in which a new motion is not reported yet: two periods of the sources and a beat
BLIND = 1.0  # s without the true motion: after 0.5 s without running a stand-in loses time (tms_sim/telemetry.py)
AFTER = 1.0  # s after a receipt in which the machine may not move either
ASSERTED = 3.0  # s within which the gateway must stop a later motion ...
UNPROVEN = 12.0  # s ... and for the receipt of that stop, which waits for a stand-still
EXTRA = 3.0  # s beyond dead time and braking in which a machine without a fault may move
JUMP = 0.5  # s from a release of its emergency stop in which a machine of OperaSim-PhysX that stands may jump
BY_ITSELF = 1.5  # s after the hit within which a motion that reaches its goal counts as not stopped
GOES_ON, INTERRUPTED, HUNG = "goes on", "interrupted", "hung"
UNTOLD = "not told"  # the database gave no answer to the last
LEFT_OUT = "left out"


@dataclass(frozen=True)
class TrialFacts:
    """The facts of a trial for its verdict."""

    trial: Trial
    model: str
    record: TrialRecording  # since `begun`
    begun: float  # the fault or the hit, whichever came first
    hit: float  # time of the signal or the command
    stop: float  # the same; for a bystander, when the run was cancelled
    ends: float  # s, dead time plus braking of the machine
    back_s: float | None
    outcome: str
    busy: str = ""  # evidence that this PC itself may have stopped the machine
    elsewhere: str = ""  # the subtask behind the motion, where another one was hit

    @property
    def watched(self) -> float:
        """When a gateway watches the machine again; before that, the host agent holds it by `emg_stop`, unwatched."""
        if not takes_gateway(self.trial):
            return -math.inf
        return math.inf if self.back_s is None else self.hit + self.back_s


@dataclass
class Row:
    """One trial in --json; times are s from the hit."""

    machine: str
    model: str
    stop: str
    how: str
    fault: str
    fault_at: float
    in_order: bool = False
    covered: bool = True
    at: float = 0.0
    void: str = ""  # why the trial proves nothing; it is repeated
    reported_s: float | None = None  # until the first stop command reached the machine
    stood_s: float | None = None  # until the machine truly stood
    travel_joint: str = ""
    travel_rad: float = 0.0
    travel_m: float = 0.0
    back_s: float | None = None
    outcome: str = LEFT_OUT
    confirmed: bool = False
    latched: bool = False
    disturbed: bool = False  # stopped, although its motion did not depend on the lost process
    unconfirmed: bool = False
    unlatched: bool = False
    ran_on: bool = False
    false_receipt: str = ""  # why a receipt is false
    last_state: str = ""  # of an unlatched machine, as its gateway told it
    receipts: list[str] = field(default_factory=list)

    def as_dict(self) -> dict[str, Any]:
        """The row for --json."""
        return {name: round(value, 3) if isinstance(value, float) else value for name, value in asdict(self).items()}


def takes_gateway(trial: Trial) -> bool:
    """Whether the hit leaves the machine without its gateway for a while."""
    return trial.stop.how is How.POWER or RC in trial.stop.processes


def empty(trial: Trial, model: str) -> Row:
    """The row of a trial that was not made."""
    stop = trial.stop
    return Row(trial.machine, model, stop.name, stop.how.value, trial.fault, trial.fault_at,
               trial.fault in IN_ORDER, stop.covered)  # fmt: skip


def judge(facts: TrialFacts) -> Row:
    """The whole verdict."""
    row, record, stop = empty(facts.trial, facts.model), facts.record, facts.trial.stop
    row.at, row.back_s, row.outcome = facts.hit, facts.back_s, facts.outcome
    row.receipts = [text_of(one, facts.hit) for one in record.receipts]
    row.false_receipt = next(filter(None, (lie(one, record, facts.watched) for one in record.receipts)), "")
    row.void = "" if row.false_receipt else void(facts)
    row.latched = bool(record.states and record.states[-1].latch)
    if row.void:
        return row
    row.confirmed = bool(record.receipts) and all(one.confirmed for one in record.receipts)
    row.unconfirmed = not row.confirmed
    row.unlatched = (row.unconfirmed or stop.latches) and not row.latched
    row.last_state = _last_state(facts) if row.unlatched else ""
    row.disturbed = not stop.moves and facts.trial.fault == NONE and any(r.begun < facts.stop for r in record.receipts)
    if row.disturbed and facts.busy:
        row.void, row.disturbed = facts.busy, False
        return row
    row.reported_s = reported(facts)
    _measure(row, facts)
    late = row.stood_s is None or row.stood_s > facts.ends + EXTRA
    row.ran_on = late and row.in_order and stop.covered
    return row


def void(facts: TrialFacts) -> str:
    """Why no stop was due, or the motion was not recorded; empty for a valid trial."""
    record = facts.record
    if facts.outcome == UNTOLD:
        return "the database did not tell how its run ended"
    before = [state for state in record.states if state.at < facts.begun][-1:]
    if any(state.latch or state.hold for state in before):
        return f"it was stopped before: {before[0].latch or before[0].hold}"
    if any(one.begun < facts.begun for one in record.receipts):
        return "it was being stopped before"
    reported = [one.at for one in record.truth]
    moments = [facts.begun, *reported[: 1 + bisect_right(reported, facts.stop + facts.ends + EXTRA)]]
    gap = max((late - early for early, late in pairwise(moments)), default=math.inf)
    if gap > BLIND:
        return f"its true motion was not received for {gap:.1f} s"
    if _stood(facts) and (facts.trial.fault == NONE or not record.receipts):  # the fault itself may have stopped it
        return "it was stopped before the hit"
    if facts.elsewhere and not record.receipts:
        return f"its run had gone on to {facts.elsewhere} before the hit"
    due = any(
        goal.began <= facts.begun and not (goal.arrived and (goal.ended or 0.0) < facts.stop + BY_ITSELF)
        for goal in record.goals.values()
    )
    return "" if due or record.receipts else "its motion ended by itself"


def _stood(facts: TrialFacts) -> bool:
    """Whether every goal had ended before the hit, and the machine stood from then on."""
    record, fresh = facts.record, facts.record.goal_after(facts.hit)
    return not _at_work(facts) and not any(facts.hit <= one.at < fresh and moves(one) for one in record.truth)


def _at_work(facts: TrialFacts) -> bool:
    """Whether a goal was open at the hit."""
    return any(one.began <= facts.hit < (one.ended or math.inf) for one in facts.record.goals.values())


def moves(sample: MotionSample) -> bool:
    """Whether the machine truly moved."""
    return sample.share > TOLERANCE


def lie(receipt: Receipt, record: TrialRecording, watched: float) -> str:
    """Why a receipt is false; empty for an honest one. Without a gateway, nobody tells of a later motion until then."""
    if not receipt.confirmed:
        return ""
    fresh = record.goal_after(receipt.at - FRAME)
    moving = [one for one in record.truth if receipt.at - CLAIMED + FRAME < one.at < fresh and moves(one)]
    before = [one for one in moving if one.at <= receipt.at - LATENCY]
    if before:
        return f"moved {receipt.at - before[-1].at:.2f} s before it was said to stand: {before[-1].share:.1f} x limit"
    overtaken = bool(moving) and fresh - moving[0].at < LATENCY  # by a goal, before a report was possible
    noticed = max(moving[0].at, watched) if moving else math.inf
    if not moving or overtaken or _reports(moving[0].at, noticed, record):
        return ""
    late = moving[0].at - receipt.at
    if late <= AFTER:
        return f"moved {late:+.2f} s after it was said to stand: {moving[0].share:.1f} x limit"
    over = min(fresh, record.truth[-1].at) - noticed > UNPROVEN
    return f"left stand-still {late:.2f} s after the receipt, and it was not reported" if over else ""


def _reports(moved: float, noticed: float, record: TrialRecording) -> bool:
    """Whether a stop that was under way at `moved`, or began in time after it, ended unconfirmed."""
    return any(not one.confirmed and one.begun < noticed + ASSERTED and one.at > moved for one in record.receipts)


def reported(facts: TrialFacts) -> float | None:
    """Seconds from a signal to the first stop command; None where none was due, or one came before."""
    stop, commands = facts.trial.stop, facts.record.commands
    if stop.how not in (How.KILL, How.FREEZE) or not (stop.moves and stop.covered) or not _at_work(facts):
        return None
    return commands[0] - facts.hit if commands and commands[0] >= facts.hit else None


def _measure(row: Row, facts: TrialFacts) -> None:
    """Fill in time and travel to the true stand-still."""
    proven = min((one.at for one in facts.record.receipts), default=math.inf)
    fresh = facts.record.goal_after(proven)  # a goal before that was stopped, too
    jumps = [(released, released + JUMP) for released in facts.record.releases]
    truth = [one for one in facts.record.truth if facts.stop <= one.at < fresh]
    truth = [one for one in truth if not any(begin <= one.at < end for begin, end in jumps)]
    if not truth:
        return
    last = next((number for number in reversed(range(len(truth))) if moves(truth[number])), None)
    if last == len(truth) - 1:
        return  # it never stood
    end = truth[0] if last is None else truth[last + 1]
    row.stood_s = 0.0 if last is None else end.at - facts.stop
    ways = {name: abs(angle - truth[0].joints[name]) for name, angle in end.joints.items()}
    row.travel_joint = max(ways, key=lambda name: ways[name], default="")
    row.travel_rad = ways.get(row.travel_joint, 0.0)
    (x, y), (x0, y0) = end.place, truth[0].place
    row.travel_m = ((x - x0) ** 2 + (y - y0) ** 2) ** 0.5


def _last_state(facts: TrialFacts) -> str:
    """What the gateway told last, and when."""
    if not facts.record.states:
        return "its gateway told no state"
    last = facts.record.states[-1]
    return f"its last state came {last.at - facts.hit:+.2f} s from the hit: {english(last.hold) or 'nothing holds it'}"


def text_of(receipt: Receipt, hit: float) -> str:
    """One receipt as text."""
    what = "confirmed" if receipt.confirmed else f"UNCONFIRMED: {english(receipt.detail)}"
    return f"{receipt.begun - hit:+.2f} s, after {receipt.seconds:.2f} s {what} ({english(receipt.cause)})"
