"""Goals of clients that wait: which one may move the machine, one at a time."""

from tms_decision import STOP_PROVEN
from tms_decision import reasons as r
from tms_decision.chain import gap, members
from tms_decision.gateway import active, notes, stops
from tms_decision.gateway.effects import End, Publish
from tms_decision.gateway.events import GoalAsked
from tms_decision.gateway.state import Gateway, Goal, Phase
from tms_reason.reason import Reason

PERMIT_LIMIT = 3.0  # s that a goal may arrive before the permits behind it: a busy PC discovers new processes late
FOREIGN = "a foreign client"


def ask(gateway: Gateway, now: float, asked: GoalAsked) -> None:
    """Take a goal; it is answered by an `End`."""
    if asked.wrong is not None:
        _refuse(gateway, asked, asked.wrong)
        return
    gateway.waiting.append(Goal(asked, now))
    admit(gateway, now)


def cancel(gateway: Gateway, now: float, number: int) -> None:
    """The client wants the goal to end: its machine is stopped, and was seen to stand when that is answered."""
    for goal in gateway.goals():
        if goal.number == number:
            goal.cancelled = True
            if goal is gateway.active and goal.stop is None:
                stops.stop(gateway, now, r.Cancelled(), stops.StopKind.PLAIN)


def _refuse(gateway: Gateway, asked: GoalAsked, why: Reason) -> None:
    gateway.log("refused", goal=asked.id, reason=why)
    gateway.do(End(asked.number, "ABORTED", why))


def admit(gateway: Gateway, now: float) -> None:
    """Let a waiting goal move the machine if nothing speaks against it any more."""
    for goal in list(gateway.waiting):
        if goal.phase is Phase.PERMIT:
            _look_for_permit(gateway, goal, now)
        if goal.phase is Phase.SETTLING:
            _settle(gateway, goal, now)


def _look_for_permit(gateway: Gateway, goal: Goal, now: float) -> None:
    missing = gap(goal.owner, gateway.held(now))
    wrong = gateway.latch.refusal(goal.owner) if gateway.latch.cause is not None else None
    if wrong is None and missing is not None and (missing.late or now - goal.since >= PERMIT_LIMIT):
        wrong = r.NoPermit(missing.reason)
    if wrong is not None:
        gateway.waiting.remove(goal)
        _refuse(gateway, goal.asked, wrong)
    elif missing is None:
        goal.wait_for_look(Phase.SETTLING, gateway, now)


def _settle(gateway: Gateway, goal: Goal, now: float) -> None:
    """Wait until the commands of all stops are over, since they would end the motion."""
    late = now - goal.since >= STOP_PROVEN
    commands = bool(gateway.doubts) or stops.busy(gateway) or gateway.beat.settling or now < gateway.standby
    if not goal.seen(gateway) or (commands and not late):
        return
    gateway.waiting.remove(goal)
    if (wrong := _keeps(gateway, goal)) is not None:
        _refuse(gateway, goal.asked, wrong)
        return
    gateway.active = goal
    goal.chain = members(goal.owner, gateway.held(now))
    gateway.vigil.end()
    goal.enter(Phase.NOTING, now)
    goal.note = _note(gateway, goal, now)
    gateway.do(Publish())
    active.go_on(gateway, now)


def _keeps(gateway: Gateway, goal: Goal) -> Reason | None:
    """What keeps a goal from the machine that the machine, or its gateway, is in."""
    if gateway.active is not None:
        return r.StillMoved(gateway.facts.name)
    if gateway.recovering or stops.busy(gateway):
        return r.NotReady(r.Recovering() if gateway.recovering else r.StopUnderWay())
    if gateway.by_hand is not None:
        return r.DrivenByHand(gateway.by_hand, gateway.facts.name)
    return gateway.latch.refusal(goal.owner)


def _note(gateway: Gateway, goal: Goal, now: float) -> int:
    """Note on the disk whose goal it is, before it leaves: else a power cut would leave the machine armed."""
    if goal.owner is None:
        return notes.hold(gateway, FOREIGN, 0)
    return notes.hold(gateway, gateway.holder(now) or f"run number {goal.owner.run}", goal.owner.run)
