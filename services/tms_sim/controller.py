"""A joint trajectory controller as ros2_control runs it: one goal at a time, tolerance at the end, soft stop."""

from collections.abc import Sequence
from dataclasses import dataclass

from tms_control.reference_trajectory import Knot, ReferenceTrajectory, refusal
from tms_reason.texts import text
from tms_sim.arm import Arm
from tms_sim.motion import Motion, MotionVerdict

TOLERANCE = 0.03  # rad, at the end of a goal
STOPPED = 0.01  # rad/s, at the end of a goal
GOAL_TIME = 60.0  # s after the end in which the arm may still arrive
SUCCESSFUL, INVALID_GOAL, PATH_VIOLATED, GOAL_VIOLATED = 0, -1, -4, -5  # control_msgs result codes


@dataclass
class TrajectoryMotion(Motion):
    """One trajectory goal."""

    reference: ReferenceTrajectory
    goal_time: float  # s


class Controller:
    """Turns goals into motion of the arm. Safe to call from several threads."""

    def __init__(self, arm: Arm) -> None:
        self.arm = arm
        self.emergency = False
        self._motion: TrajectoryMotion | None = None
        self._braking: MotionVerdict | None = None  # verdict of the motion once the arm stands
        self._lock = arm.lock

    @property
    def busy(self) -> bool:
        """Whether a goal is open."""
        return self._motion is not None

    def refusal(self, names: Sequence[str], points: Sequence[Knot]) -> tuple[int, str] | None:
        """Result code and reason of a goal's refusal, or None."""
        if self.emergency:
            return INVALID_GOAL, "the emergency stop is on: publish false on emg_stop to release it"
        refused = refusal(self.arm.joints, names, points)
        return None if refused is None else (refused[0], text(refused[1], "en"))

    def begin(self, names: Sequence[str], points: Sequence[Knot], goal_time: float = 0.0) -> TrajectoryMotion:
        """Follow a trajectory that was not refused; a motion under way is preempted."""
        with self._lock:
            if self._motion is not None:
                self._motion.end(MotionVerdict("ABORTED", INVALID_GOAL, "preempted by a newer goal"))
            motion = TrajectoryMotion(self.arm.follow(names, points), goal_time or GOAL_TIME)
            self._motion, self._braking = motion, None
            if self.emergency:  # pressed between the check and now
                self._brake(MotionVerdict("ABORTED", PATH_VIOLATED, "emergency stop"))
            return motion

    def cancel(self, motion: TrajectoryMotion) -> None:
        """Brake; the motion ends CANCELED once the arm stands."""
        with self._lock:
            if motion is self._motion:
                self._brake(MotionVerdict("CANCELED", SUCCESSFUL, "stopped on request"))

    def stop(self, on: bool) -> None:
        """Set the level of the emergency stop: while true, goals are refused. The caller stops the arm."""
        with self._lock:
            self.emergency = on
            if on and self._braking is None:
                self._braking = MotionVerdict("ABORTED", PATH_VIOLATED, "emergency stop")

    def _brake(self, verdict: MotionVerdict) -> None:
        self.arm.hold()
        self._braking = verdict

    def step(self, seconds: float) -> None:
        """Let machine time pass and end the motion when it is due."""
        with self._lock:
            self.arm.step(seconds)
            motion = self._motion
            if motion is None:
                self._braking = None
                return
            verdict = self._ended(motion)
            if verdict is not None:
                self._leave(verdict)
                self._motion = self._braking = None
                motion.end(verdict)

    def _leave(self, verdict: MotionVerdict) -> None:
        if verdict.outcome == "SUCCEEDED":
            self.arm.finish()
        elif self._braking is None:
            self.arm.hold()

    def _ended(self, motion: TrajectoryMotion) -> MotionVerdict | None:
        if self._braking is not None:
            return self._braking if self.arm.stands else None
        late = self.arm.elapsed - motion.reference.duration
        if late < 0:
            return None
        apart = [abs(q - end) for q, end in zip(self.arm.positions, motion.reference.end, strict=True)]
        if max(apart) <= TOLERANCE and all(abs(velocity) <= STOPPED for velocity in self.arm.velocities):
            return MotionVerdict("SUCCEEDED")
        if late <= motion.goal_time:
            return None
        name = list(self.arm.joints)[apart.index(max(apart))]
        text = f"{name} is {max(apart):.3f} rad off its goal {motion.goal_time:.0f} s after its time"
        return MotionVerdict("ABORTED", GOAL_VIOLATED, text)
