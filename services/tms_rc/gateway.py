"""Passes goals on to the machine's own action servers, one at a time, and ends them when they must end."""

import time
from collections.abc import Sequence
from typing import Any

from tms_core.app import App
from tms_core.border import Motion
from tms_core.errors import RosError
from tms_core.fence import parse
from tms_core.ros import LOST_TEXT, Call, Ended, Goal, Outcome, Peer
from tms_rc import limits
from tms_rc.guard import Active, Guard, Kind
from tms_rc.standstill import StandStill
from tms_rc.stopper import STOP_LIMIT

SERVER_LIMIT = 3.0  # s for the machine's server to be there, and for news of the machine to be heard
ACCEPT_LIMIT = 3.0  # s for it to answer a goal
OVERRUN = 10.0  # s that a trajectory may last beyond its own duration
FROZEN = 0.8  # s that a look may take
LOOK = 0.1  # s between looks at limits and sensors while it moves
REFUSED = -1  # control_msgs INVALID_GOAL
UNKNOWN = 600  # nav2_msgs, where a result has an unsigned code


class Gateway:
    """Between everyone who wants a motion and the machine."""

    def __init__(self, app: App, guard: Guard, watch: StandStill) -> None:
        self._app, self._guard, self._watch = app, guard, watch
        self._model = app.site.model_of(app.machine)
        self._speed = app.site.file.sim.speed if app.site.file.backend == "sim" else 1.0

    def serve(self, motion: Motion, peer: Peer) -> None:
        """Offer /<machine>/rc/<action> in front of the machine's own action."""
        name = f"/{self._app.machine}/rc/{motion.served}"
        self._app.ros.serve(motion.type, name, lambda goal: self._run(motion, peer, goal))

    def _run(self, motion: Motion, peer: Peer, goal: Goal) -> Ended:
        active = Active(goal, parse(goal.uuid), peer, {}, self._watch.positions)
        wrong = self._limits(motion, goal.request) or self._guard.take(active)
        if wrong is not None:
            self._app.log.warning("event=refused goal=%s reason=%r", goal.id, wrong)
            return aborted(motion, wrong)
        try:
            return self._pass_on(motion, active)
        except RosError as error:
            return aborted(motion, str(error))
        finally:
            self._guard.release()

    def _limits(self, motion: Motion, request: Any) -> str | None:
        if hasattr(request, "trajectory"):
            wanted = request.trajectory
            points = [point.positions for point in wanted.points]
            present = self._watch.positions
            return limits.problem(self._model, wanted.joint_names, points, present) or limits.pace_problem(
                self._model, wanted.joint_names, [_point(point) for point in wanted.points], present, self._speed
            )
        if hasattr(request, "target_angle"):
            return limits.angle_problem(self._model, motion.field, request.target_angle, self._watch.positions)
        return limits.pose_problem([_numbers(stamped.pose) for stamped in poses_of(request)])

    def _pass_on(self, motion: Motion, active: Active) -> Ended:
        active.peer.wait_ready(SERVER_LIMIT)
        unseen = self._unseen(active.goal)
        if unseen is not None:
            return aborted(motion, f"not ready: {unseen}")
        active.goal.on_cancel = lambda: self._app.ros.on_executor(lambda: self._cancel(active))
        self._app.ros.on_executor(lambda: self._send(active))
        self._wait(active, lambda call: call.accepted, ACCEPT_LIMIT)
        if active.stop is None and not (active.call is not None and (active.call.accepted or active.ended())):
            self._guard.stop(f"{LOST_TEXT}: {active.peer.name} did not answer a goal", Kind.PLAIN)
            if active.call is not None:
                active.peer.doubt(active.call)
        self._watch_motion(active)
        call = active.call
        if active.stop is not None or call is None:
            return self._stopped(motion, active)
        if call.outcome is Outcome.SUCCEEDED:
            return Outcome.SUCCEEDED, call.result
        if call.outcome is Outcome.CANCELED:  # nobody asked us: whoever stands in for a gateway that seems lost
            return aborted(motion, f"{LOST_TEXT}: somebody else cancelled the motion at the machine")
        text = (
            reason_of(call.result) or f"the machine's controller ended it: {call.outcome.name if call.outcome else ''}"
        )
        return Outcome.ABORTED, call.result if reason_of(call.result) else aborted(motion, text)[1]

    def _unseen(self, goal: Goal) -> str | None:
        """What is not heard of the machine: it would be stopped and latched as soon as it moves.

        A machine that was switched on just now may be heard here a moment later than where the goal comes from.
        """
        deadline = time.monotonic() + SERVER_LIMIT
        while (silent := self._guard.silent()) is not None and time.monotonic() < deadline:
            if goal.cancelled.wait(LOOK):
                return None  # the goal ends as cancelled
        return silent

    def _send(self, active: Active) -> None:
        """On the executor thread, like stops: after a stop no goal leaves, nor one that has been answered meanwhile."""
        if self._guard.active is not active:  # this thread stood still for so long that it was given up
            return
        self._guard.last_look(active)
        if active.goal.cancelled.is_set():
            self._cancel(active)
        if active.stop is None:
            active.call = active.peer.send(
                active.goal.request, on_change=lambda _call: active.wake(), on_feedback=active.goal.publish
            )

    def _cancel(self, active: Active) -> None:
        if active.stop is None and self._guard.active is active:
            self._guard.stop_now("cancel", Kind.PLAIN)

    def _watch_motion(self, active: Active) -> None:
        """Until the goal is terminal or a stop has begun."""
        deadline = time.monotonic() + _duration(active.goal.request) + OVERRUN
        while active.stop is None and not (active.call is not None and active.ended()):
            before = time.monotonic()
            self._wait(active, lambda call: call.outcome is not None, LOOK)
            frozen = time.monotonic() - before
            if frozen > FROZEN and active.stop is None:  # its own news of the machine are old, not the machine silent
                self._guard.stop(f"{LOST_TEXT}: the gateway itself did not run for {frozen:.1f} s", Kind.HOLD)
                break
            if active.stop is None and active.call is not None and active.call.accepted and active.peer.left():
                self._guard.stop(f"{LOST_TEXT}: {active.peer.name} went away during its goal", Kind.PLAIN)
                active.peer.lost()  # ends the goal, which nobody answers any more
                break
            wrong = limits.escaped(self._model, self._watch.positions, active.start)
            wrong = wrong or (f"{silent} while it moves" if (silent := self._guard.silent()) else None)
            if wrong is not None and active.stop is None:
                self._guard.stop(wrong, Kind.LATCH)
            elif time.monotonic() > deadline and active.stop is None:
                self._guard.stop("the motion takes too long", Kind.PLAIN)

    def _wait(self, active: Active, enough: Any, seconds: float) -> None:
        def over() -> bool:
            call: Call | None = active.call
            return active.stop is not None or (call is not None and (enough(call) or call.outcome is not None))

        with active.changed:
            active.changed.wait_for(over, seconds)

    def _stopped(self, motion: Motion, active: Active) -> Ended:
        stop = active.stop
        if stop is None or not stop.over.wait(STOP_LIMIT + 1.0) or stop.receipt is None:
            return aborted(motion, "stopped, but nobody saw the end of it")
        receipt = stop.receipt
        if not receipt.confirmed:
            return aborted(motion, f"stop unconfirmed: {receipt.detail} ({stop.cause})")
        text = f"stood after {receipt.seconds:.2f} s, {receipt.travel:.3f} rad or m ({stop.cause})"
        if not active.goal.cancelled.is_set() or self._guard.latch.cause:
            return aborted(motion, text)
        if self._app.stopping.is_set():
            return Outcome.CANCELED, with_reason(motion, f"{LOST_TEXT}: the gateway was stopped; {text}")
        return Outcome.CANCELED, with_reason(motion, text, 0)


def poses_of(request: Any) -> Sequence[Any]:
    """The poses of a goal for the navigation."""
    return list(request.poses) if hasattr(request, "poses") else [request.pose]


def _numbers(pose: Any) -> tuple[float, ...]:
    at, turn = pose.position, pose.orientation
    return at.x, at.y, at.z, turn.x, turn.y, turn.z, turn.w


def _seconds(duration: Any) -> float:
    return float(duration.sec + duration.nanosec * 1e-9)


def _point(point: Any) -> limits.Point:
    rest = [*point.velocities, *point.accelerations, *point.effort]
    return limits.Point(_seconds(point.time_from_start), point.positions, rest)


def _duration(request: Any) -> float:
    """How long a goal says that it lasts [s]; navigation does not say."""
    if not hasattr(request, "trajectory"):
        return float("inf")
    return _seconds(request.trajectory.points[-1].time_from_start)


def reason_of(result: Any) -> str:
    """The text in a result, where its type has one."""
    return str(getattr(result, "error_string", "") or getattr(result, "error_msg", ""))


def with_reason(motion: Motion, text: str, code: int | None = None) -> Any:
    """A result of the motion's type that tells as much as the type has room for."""
    result = motion.type.Result()
    if hasattr(result, "error_string"):
        result.error_code, result.error_string = REFUSED if code is None else code, text
    elif hasattr(result, "error_msg"):
        result.error_code, result.error_msg = UNKNOWN if code is None else code, text
    return result


def aborted(motion: Motion, text: str) -> Ended:
    """The end of a goal that must not go on."""
    return Outcome.ABORTED, with_reason(motion, text)
