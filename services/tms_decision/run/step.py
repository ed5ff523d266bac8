"""The one function of a run: something happens, and it decides.

No machine moves before the permits are held, which is after the run's facts are on the disk; they are dropped when its
machines were stopped, or when a success has left nothing open.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import Enum

from tms_decision import STOP_PROVEN
from tms_decision.reasons import GoalNotEnded, HaltedGoalsEnd, NotResumed, SoftwareStop, StopRequested
from tms_decision.run import effects as f
from tms_decision.run import events as e
from tms_reason.reason import Reason, Several

TICK_LIMIT = 0.4  # s without a tick after which the permits of its motions end
SETTLE_LIMIT = STOP_PROVEN + 7.0  # s for goals to end after a halt
UNCONFIRMED, INTERRUPTED, SUCCESS = "stop_unconfirmed", "interrupted", "success"


class Phase(Enum):
    """What a run does."""

    PREPARING = "starts what it needs; no machine may move"
    RUNNING = "is ticked"
    HALTING = "halts its tree"
    STOPPING = "has its machines stopped"
    SETTLING = "waits for its goals to end"
    OVER = "has ended"


@dataclass
class Run:
    """The state of one run. Only `step` changes it."""

    resumed: bool = False
    phase: Phase = Phase.PREPARING
    held: bool = False  # whether it holds the permits of its machines
    asked: e.EndAsked | None = None  # how it ends, if it is ended from outside
    outcome: str = "failure"
    why: Reason | None = None
    refused: Reason | None = None
    unseen: list[Reason] = field(default_factory=list)  # machines that were not seen to stand
    since: float = 0.0  # when its phase began
    ticked: float = 0.0  # when the last tick ended
    out: list[f.Effect] = field(default_factory=list)  # of this step

    def works(self, now: float) -> bool:
        """Whether that what decides about its motions is at work: without, its permits lapse."""
        return self.phase is not Phase.RUNNING or now - self.ticked < TICK_LIMIT

    def enter(self, phase: Phase, now: float, *effects: f.Effect) -> None:
        """Go on to a phase."""
        self.phase, self.since = phase, now
        self.out.extend(effects)


def step(run: Run, event: e.Event, now: float) -> list[f.Effect]:
    """Let something happen; returns what is to be done, in this order."""
    match event, run.phase:
        case e.EndAsked(), _:
            run.asked = run.asked or event
        case e.StoppedOutside(machine, cause), _:
            outcome = "cancelled" if cause.find(SoftwareStop) is not None else "failure"
            run.asked = run.asked or e.EndAsked(outcome, StopRequested(machine, cause))
        case e.Prepared(), Phase.PREPARING:
            run.held = True
            run.out.append(f.Hold())
        case e.Held(back), Phase.PREPARING:
            _begin(run, back, now)
        case e.Refused(why), phase if phase is not Phase.OVER:
            _refuse(run, why, now)
        case e.Ticked(status, why), Phase.RUNNING:
            run.ticked = now
            if status:
                _halt(run, status, why, now)
        case e.Halted(moves), Phase.HALTING:
            _halted(run, moves, now)
        case e.Stood(unseen), Phase.STOPPING:
            run.unseen = list(unseen)
            run.enter(Phase.SETTLING, now)
        case e.Looked(moves, names), Phase.SETTLING:
            _look(run, moves, names, now)
    if run.phase is Phase.RUNNING and run.asked is not None:
        _halt(run, run.asked.outcome, run.asked.why, now)
    out, run.out = run.out, []
    return out


def _begin(run: Run, back: Reason | None, now: float) -> None:
    if back is not None and run.asked is None:
        return _refuse(run, back, now)
    run.ticked = now
    run.enter(Phase.RUNNING, now, f.Enter("running"))


def _refuse(run: Run, why: Reason, now: float) -> None:
    """End the run before any machine has moved; one that was to be resumed stays interrupted."""
    run.refused = why
    run.outcome, run.why = (INTERRUPTED, NotResumed(why)) if run.resumed else ("refused", why)
    _end(run, now)


def _halt(run: Run, outcome: str, why: Reason | None, now: float) -> None:
    run.outcome, run.why = outcome, why
    if outcome != SUCCESS:
        run.out.append(f.Enter("stopping", why))
    run.enter(Phase.HALTING, now, f.Halt())


def _halted(run: Run, moves: bool, now: float) -> None:
    """Stop the machines, except after a success without open goals: then no machine moves."""
    if run.outcome == SUCCESS:
        run.why = None
        if not moves:
            return _end(run, now)
        run.out.append(f.Enter("stopping", HaltedGoalsEnd()))  # the tree succeeded in the tick that halted a leaf
    run.enter(Phase.STOPPING, now, f.StopMachines(run.outcome))


def _look(run: Run, moves: bool, names: Sequence[str], now: float) -> None:
    if moves and now - run.since < SETTLE_LIMIT:
        return
    run.unseen += [GoalNotEnded(name) for name in names]
    run.out.extend(f.Alarm(what) for what in run.unseen)
    if run.unseen:
        run.outcome = UNCONFIRMED
        run.why = Several((*run.unseen, *([run.why] if run.why is not None else [])))
    _end(run, now)


def _end(run: Run, now: float) -> None:
    ended, drop = f.Enter(run.outcome, run.why, ended=True), [f.Drop()] if run.held else []
    if run.outcome == INTERRUPTED:
        run.enter(Phase.OVER, now, ended, f.KeepInterrupted(), *drop)
    else:
        run.enter(Phase.OVER, now, f.KeepEnd(run.outcome, run.why), ended, f.Forget(), *drop)
