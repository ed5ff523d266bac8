"""Passes goals on to the machine's own action servers, one at a time, and stops them when the machine must stop."""

from collections.abc import Callable
from typing import Any

from tms_config.clock import monotonic, sleep
from tms_machine.border import MotionAction
from tms_machine.reasons import StopUnconfirmed
from tms_machine.receipts import stood_after
from tms_rc import limits
from tms_rc.active import Active, StopKind
from tms_rc.following import Follower, ways
from tms_rc.guard import Guard
from tms_rc.motion_goals import aborted, duration, numbers, point_of, poses_of, reason_of, seconds, with_reason
from tms_rc.reasons import (
    Cancelled,
    CancelledElsewhere,
    ControllerAway,
    ControllerEnded,
    ControllerLeft,
    Frozen,
    GatewayStood,
    GatewayStopped,
    NoEnd,
    NoGoalAnswer,
    NotReady,
    OffPath,
    TooLong,
    WhileMoving,
)
from tms_rc.standstill import JOINTS, StandStill
from tms_reason import wire
from tms_reason.errors import RosError
from tms_reason.reason import Reason
from tms_ros.client import AnyCall, AnyPeer
from tms_ros.goals import Ended, Outcome
from tms_ros.loop import POLL
from tms_ros.reasons import ProcessLost
from tms_ros.server import AnyGoal
from tms_runtime.app import App
from tms_runtime.fence import parse

SERVER_LIMIT = 3.0  # s for the machine's server to be there, and for the machine's messages to be received
ACCEPT_LIMIT = 3.0  # s for the machine's server to answer a goal
OVERRUN = 10.0  # s that a trajectory may last beyond its own duration
FROZEN = 0.65  # s that one check may take: a gateway that stood still for 0.7 s stops its machine
LIMIT_CHECK_PERIOD = 0.1  # s between checks of limits and sensors while the machine moves


class Gateway:
    """Stands between all clients that ask for a motion and the machine."""

    def __init__(self, app: App, guard: Guard, watch: StandStill) -> None:
        self._app, self._guard, self._watch = app, guard, watch
        self._model = app.site.model_of(app.machine)
        self._speed = speed_of(app)

    def serve(self, motion: MotionAction, peer: AnyPeer) -> None:
        """Offer /<machine>/rc/<action> in front of the machine's own action."""
        name = f"/{self._app.machine}/rc/{motion.served}"
        self._app.ros.serve(motion.type, name, lambda goal: self._run(motion, peer, goal))

    def _run(self, motion: MotionAction, peer: AnyPeer, goal: AnyGoal) -> Ended[Any]:
        active = Active(goal, parse(goal.uuid), peer, {}, self._watch.positions)
        wrong = self._limits(motion, goal.request) or self._guard.take(active)
        if wrong is not None:
            self._app.log.warning("refused", goal=goal.id, reason=wrong)
            return aborted(motion, wrong)
        try:
            return self._pass_on(motion, active)
        except RosError as error:
            return aborted(motion, error.reason)
        finally:
            self._guard.release()

    def _limits(self, motion: MotionAction, request: Any) -> Reason | None:
        if hasattr(request, "trajectory"):
            wanted = request.trajectory
            points = [point.positions for point in wanted.points]
            present = self._watch.positions
            return limits.problem(self._model, wanted.joint_names, points, present) or limits.pace_problem(
                self._model, wanted.joint_names, [point_of(point) for point in wanted.points], present, self._speed
            )
        if hasattr(request, "target_angle"):
            return limits.angle_problem(self._model, motion.field, request.target_angle, self._watch.positions)
        return limits.pose_problem([numbers(stamped.pose) for stamped in poses_of(request)])

    def _pass_on(self, motion: MotionAction, active: Active) -> Ended[Any]:
        if not self._reachable(active):
            return aborted(motion, ControllerAway(self._app.machine, active.peer.name))
        unseen = self._unseen(active.goal)
        if unseen is not None:
            return aborted(motion, NotReady(unseen))
        refused = self._guard.watch.trouble(monotonic())
        if refused is not None:
            return aborted(motion, NotReady(refused.reason))
        active.goal.on_cancel = lambda: self._app.ros.on_executor(lambda: self._cancel(active))
        self._app.ros.on_executor(lambda: self._send(active))
        self._wait(active, lambda call: call.accepted, ACCEPT_LIMIT)
        if active.stop is None and not (active.call is not None and (active.call.accepted or active.ended())):
            self._guard.stop(ProcessLost(NoGoalAnswer(self._app.machine, active.peer.name)), StopKind.PLAIN)
            if active.call is not None:
                active.peer.resolve_unanswered(active.call)
        self._watch_motion(motion, active)
        call = active.call
        if active.stop is not None or call is None:
            return self._stopped(motion, active)
        if call.outcome is Outcome.SUCCEEDED:
            return Outcome.SUCCEEDED, call.result
        if call.outcome is Outcome.CANCELED:  # not by our client: the standby of a gateway that seems lost did it
            return aborted(motion, ProcessLost(CancelledElsewhere()))
        if reason_of(call.result):
            return Outcome.ABORTED, call.result
        outcome = call.outcome.name if call.outcome is not None else ""
        return aborted(motion, ControllerEnded(self._app.machine, outcome))

    def _reachable(self, active: Active) -> bool:
        deadline = monotonic() + SERVER_LIMIT
        while not active.peer.ready():
            if monotonic() > deadline:
                return False
            sleep(POLL)
        return True

    def _unseen(self, goal: AnyGoal) -> Reason | None:
        """Which source of the machine is silent: the machine would be stopped and latched as soon as it moves.

        The messages of a machine that was just switched on may arrive here a moment later than at the goal's sender.
        """
        deadline = monotonic() + SERVER_LIMIT
        while (silent := self._guard.silent()) is not None and monotonic() < deadline:
            if goal.cancelled.wait(LIMIT_CHECK_PERIOD):
                return None  # the goal ends as cancelled
        return silent

    def _send(self, active: Active) -> None:
        """Send the goal, on the executor thread like stops: none leaves after a stop, or after it has been answered."""
        if self._guard.active is not active:  # this thread stood still for so long that it was given up
            return
        self._guard.last_look(active)
        if active.goal.cancelled.is_set():
            self._cancel(active)
        if active.stop is None:
            active.sent = monotonic()
            active.call = active.peer.send(
                active.goal.request, on_change=lambda _call: active.wake(), on_feedback=active.goal.publish
            )

    def _cancel(self, active: Active) -> None:
        if active.stop is None and self._guard.active is active:
            self._guard.stop_now(Cancelled(), StopKind.PLAIN)

    def _watch_motion(self, motion: MotionAction, active: Active) -> None:
        """Watch the motion until the goal has ended or a stop has begun."""
        deadline = monotonic() + duration(active.goal.request) + OVERRUN
        while active.stop is None and not (active.call is not None and active.ended()):
            before = monotonic()
            self._wait(active, lambda call: call.outcome is not None, LIMIT_CHECK_PERIOD)
            frozen = monotonic() - before
            if frozen > FROZEN and active.stop is None:  # the gateway has read no message, the machine is not silent
                self._guard.stop(ProcessLost(GatewayStood(frozen)), StopKind.HOLD)
                break
            if active.stop is None and active.call is not None and active.call.accepted and active.peer.left():
                self._guard.stop(ProcessLost(ControllerLeft(self._app.machine, active.peer.name)), StopKind.PLAIN)
                active.peer.mark_lost()  # ends the goal, as no server is left to end it
                break
            wrong = self._wrong(motion, active)
            if wrong is not None and active.stop is None:
                self._guard.stop(*wrong)
            elif monotonic() > deadline and active.stop is None:
                self._guard.stop(TooLong(), StopKind.PLAIN)

    def _wrong(self, motion: MotionAction, active: Active) -> tuple[Reason, StopKind] | None:
        """Why the machine must stop, and what that means for the next motion."""
        now, watch = monotonic(), self._watch
        escaped = limits.escaped(self._model, watch.positions, active.start)
        if escaped is not None:
            return escaped, StopKind.LATCH
        if (silent := self._guard.silent()) is not None:
            return WhileMoving(silent), StopKind.LATCH
        if (trouble := watch.trouble(now)) is not None:
            return WhileMoving(trouble.reason), StopKind.HOLD if trouble.passes and active.owner else StopKind.LATCH
        if active.call is None or not active.call.accepted:
            return None
        if not active.begun:
            self._begin(motion, active, now)
        if active.follower is None:
            return None
        if (frozen := self._frozen(active, active.follower, now)) is not None:
            return frozen, StopKind.LATCH
        wrong = active.follower.check(now, watch.positions)
        return None if wrong is None else (wrong, StopKind.LATCH if isinstance(wrong, OffPath) else StopKind.PLAIN)

    def _begin(self, motion: MotionAction, active: Active, now: float) -> None:
        """The goal was accepted: from now on the machine should follow."""
        wanted = getattr(active.goal.request, "trajectory", None)
        if wanted is not None:
            points = [(seconds(point.time_from_start), point.positions) for point in wanted.points]
            found = ways(wanted.joint_names, points, active.start)
            active.follower = Follower(found, self._watch.reached, now, self._speed)
        elif hasattr(active.goal.request, "target_angle") and not self._app.site.border(self._app.machine).dump_returns:
            active.follower = self._turn(motion, active, now)
        active.begun = now

    def _turn(self, motion: MotionAction, active: Active, now: float) -> Follower | None:
        """Follow one joint to an angle at the slowest pace of its server: only the end of its motion is known."""
        joint = self._model.turned(motion.field)
        if joint is None or joint not in active.start:
            return None
        limits_of, angle = self._model.joints[joint], float(active.goal.request.target_angle)
        seconds = abs(angle - active.start[joint]) / limits_of.velocity + limits_of.velocity / limits_of.acceleration
        found = ways([joint], [(seconds, [angle])], active.start)
        return Follower(found, self._watch.reached, now, self._speed)

    def _frozen(self, active: Active, follower: Follower, now: float) -> Reason | None:
        """Whether the joint states are bit for bit the same while the goal should change them."""
        source = self._watch.sources.get(JOINTS)
        if source is None:
            return None
        same = now - max(source.changed, active.begun + self._watch.reached / self._speed)
        if same <= source.source.frozen_after or not follower.moved(now, same):
            return None
        return Frozen(source.label, same)

    def _wait(self, active: Active, enough: Callable[[AnyCall], bool], seconds: float) -> None:
        def over() -> bool:
            call: AnyCall | None = active.call
            return active.stop is not None or (call is not None and (enough(call) or call.outcome is not None))

        with active.changed:
            active.changed.wait_for(over, seconds)

    def _stopped(self, motion: MotionAction, active: Active) -> Ended[Any]:
        stop = active.stop
        if stop is None:
            return aborted(motion, NoEnd())
        receipt = stop.wait(self._app.machine)
        if not receipt.confirmed:
            return aborted(motion, StopUnconfirmed(wire.known(receipt.detail), stop.cause))
        stood = stood_after(receipt, stop.cause)
        if not active.goal.cancelled.is_set() or self._guard.latch.cause:
            return aborted(motion, stood)
        if self._app.stopping.is_set():
            return Outcome.CANCELED, with_reason(motion, ProcessLost(GatewayStopped(stood)))
        return Outcome.CANCELED, with_reason(motion, stood, 0)


def speed_of(app: App) -> float:
    """Seconds of the machine in one second: stand-ins may run faster."""
    return app.site.file.sim.speed if app.site.file.backend == "sim" else 1.0
