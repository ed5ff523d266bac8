"""Turns joints to an angle on request, like the servers of a carrier's vessel and upper body."""

import math
from dataclasses import dataclass

from tms_reason.texts import text
from tms_sim.arm import Arm
from tms_sim.motion import ABORTED, CANCELED, SUCCEEDED, Motion, MotionVerdict

TOLERANCE = 0.005  # rad
STOPPED = 0.01  # rad/s
HELD = 3.0  # s that a vessel stays tipped before it returns by itself


@dataclass
class Turn(Motion):
    """One goal for one joint."""

    joint: str
    target: float  # rad
    braking: MotionVerdict | None = None  # verdict when the joint stands
    held: float = 0.0  # s at the target, for a joint that then returns to 0


class Turner:
    """Turns goals into motion of single joints; a new goal for a joint preempts the old one."""

    def __init__(self, arm: Arm, returns: bool = False) -> None:
        """`returns`: a goal tips, waits, returns to 0 and cannot be cancelled, as OPERA's helper for the simulator."""
        self.arm, self._returns = arm, returns
        self._turns: dict[str, Turn] = {}
        self._lock = arm.lock
        self.emergency = False

    @property
    def busy(self) -> bool:
        """Whether a goal is open."""
        return bool(self._turns)

    def refusal(self, joint: str, angle: float) -> str | None:
        """Why a goal is refused, or None."""
        if self.emergency:
            return "the emergency stop is on: publish false on emg_stop to release it"
        if not math.isfinite(angle):
            return f"{joint}: the angle is not a number"
        broken = self.arm.joints[joint].violation(angle)
        return f"{joint}: {text(broken, 'en')}" if broken else None

    def begin(self, joint: str, angle: float) -> Turn:
        """Turn a joint whose goal was not refused; a joint without limits takes the shorter way."""
        limits = self.arm.joints[joint]
        if limits.min is None and limits.max is None:
            now = self.angle(joint)
            angle = now + math.remainder(angle - now, math.tau)
        with self._lock:
            before = self._turns.pop(joint, None)
            if before is not None:
                before.end(MotionVerdict(ABORTED, text="preempted by a newer goal"))
            turn = self._turns[joint] = Turn(joint, angle)
            self.arm.targets[joint] = angle
            self.arm.speeds.pop(joint, None)
            if self.emergency:  # pressed between the check and now
                self._brake(turn, MotionVerdict(ABORTED, text="emergency stop"))
            return turn

    def cancel(self, turn: Turn) -> None:
        """Brake; the goal ends CANCELED once the joint stands."""
        with self._lock:
            if self._turns.get(turn.joint) is turn and not self._returns:
                self._brake(turn, MotionVerdict(CANCELED, text="stopped on request"))

    def stop(self, on: bool) -> None:
        """Set the level of the emergency stop."""
        with self._lock:
            self.emergency = on
            for turn in self._turns.values():
                if on and turn.braking is None:
                    self._brake(turn, MotionVerdict(ABORTED, text="emergency stop"))

    def angle(self, joint: str) -> float:
        """Position of a joint [rad]."""
        return self.arm.servos[joint].position

    def _brake(self, turn: Turn, verdict: MotionVerdict) -> None:
        self.arm.release(turn.joint)
        turn.braking = verdict

    def step(self, seconds: float) -> None:
        """End the goals that are due; the arm has been stepped before."""
        with self._lock:
            for turn in list(self._turns.values()):
                verdict = self._ended(turn, seconds)
                if verdict is not None:
                    self.arm.targets.pop(turn.joint, None)
                    del self._turns[turn.joint]
                    turn.end(verdict)

    def _ended(self, turn: Turn, seconds: float) -> MotionVerdict | None:
        servo = self.arm.servos[turn.joint]
        if turn.braking is not None:
            return turn.braking if servo.stands else None
        there = abs(servo.position - turn.target) <= TOLERANCE and abs(servo.velocity) <= STOPPED
        if there and self._returns and turn.target != 0.0:
            there = self._return(turn, seconds)
        return MotionVerdict(SUCCEEDED) if there else None

    def _return(self, turn: Turn, seconds: float) -> bool:
        """Wait at the target, then return to 0; False, since the goal is not over yet."""
        turn.held += seconds
        if turn.held >= HELD:
            turn.target = self.arm.targets[turn.joint] = 0.0
        return False
