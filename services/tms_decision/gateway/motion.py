"""The watch over the motion of the active goal."""

from tms_decision import reasons as r
from tms_decision.gateway import stops
from tms_decision.gateway.effects import GiveUp, Lose
from tms_decision.gateway.state import SCHEDULER, Gateway, Goal, Phase
from tms_decision.gateway.stops import StopKind
from tms_proof.following import Follower
from tms_proof.reasons import Frozen, OffPath
from tms_proof.standstill import JOINTS
from tms_reason.reason import Reason

ACCEPT_LIMIT = 3.0  # s for the machine's server to answer a goal
OVERRUN = 10.0  # s that a motion may last beyond its own duration
FROZEN = 0.65  # s between two beats: a gateway that stood still for 0.7 s stops its machine


def watch(gateway: Gateway, now: float, since: float) -> None:
    """Stop the active goal if the machine must not move any longer; `since`: when this was last looked at."""
    goal = gateway.active
    if goal is None or goal.stop is not None or goal.phase not in (Phase.SENT, Phase.MOVING):
        return
    frozen = now - max(since, goal.sent)
    if frozen > FROZEN:  # the gateway has read no message, the machine is not silent
        stops.stop(gateway, now, r.ProcessLost(r.GatewayStood(frozen)), StopKind.HOLD)
    elif goal.phase is Phase.SENT and now - goal.since >= ACCEPT_LIMIT:
        unanswered = r.NoGoalAnswer(gateway.facts.name, goal.asked.server)
        stops.stop(gateway, now, r.ProcessLost(unanswered), StopKind.PLAIN)
        gateway.do(GiveUp(goal.number))
    elif goal.phase is Phase.MOVING and gateway.beat.gone:
        away = r.ControllerLeft(gateway.facts.name, goal.asked.server)
        stops.stop(gateway, now, r.ProcessLost(away), StopKind.PLAIN)
        gateway.do(Lose(goal.number))
    elif (wrong := _wrong(gateway, goal, now)) is not None:
        stops.stop(gateway, now, *wrong)
        if (silent := gateway.silent(now)) is not None:  # nothing shows now what it does: this is told at once
            stops.stop(gateway, now, *wrong, broken=silent).limit = now
    elif goal.phase is Phase.MOVING and now - goal.since > goal.asked.lasts + OVERRUN:
        stops.stop(gateway, now, r.TooLong(), StopKind.PLAIN)


def _wrong(gateway: Gateway, goal: Goal, now: float) -> tuple[Reason, StopKind] | None:
    """Why the machine must stop, and what that means for the next motion."""
    if (escaped := gateway.beat.escaped) is not None:
        return escaped, StopKind.LATCH if escaped.find(r.ProcessLost) is None else StopKind.HOLD
    if (silent := gateway.silent(now)) is not None:
        return r.WhileMoving(silent), StopKind.LATCH
    if (trouble := gateway.watch.trouble(now)) is not None:
        passes = trouble.passes and goal.owner is not None
        return r.WhileMoving(trouble.reason), StopKind.HOLD if passes else StopKind.LATCH
    if goal.follower is None:
        return None
    if (frozen := _frozen(gateway, goal, goal.follower, now)) is not None:
        return frozen, StopKind.LATCH
    wrong = goal.follower.check(now, gateway.watch.seen(now))
    return None if wrong is None else (wrong, StopKind.LATCH if isinstance(wrong, OffPath) else StopKind.PLAIN)


def _frozen(gateway: Gateway, goal: Goal, follower: Follower, now: float) -> Reason | None:
    """Whether the joint states are bit for bit the same while the goal should change them."""
    source = gateway.watch.sources.get(JOINTS)
    if source is None:
        return None
    same = now - max(source.changed, goal.begun + gateway.watch.reached / gateway.facts.speed)
    frozen = same > source.source.frozen_after and follower.moved(now, same)
    return Frozen(source.label, same) if frozen else None


def check_chain(gateway: Gateway, now: float) -> None:
    """Stop the machine when a process behind the active goal is gone."""
    goal = gateway.active
    if goal is None or goal.stop is not None or goal.owner is None:
        return
    held = gateway.held(now)
    gone = [name for name, what in goal.chain.items() if held.get(name) != what]
    if gone:
        names = tuple(f"{'tms' if name == SCHEDULER else gateway.facts.name}:{name}" for name in gone)
        stops.stop(gateway, now, r.ProcessLost(r.ProcessesLost(names)), StopKind.HOLD)
