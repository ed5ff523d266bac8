"""A joint trajectory controller as ros2_control runs it: one goal at a time, tolerance at the end, soft stop."""

from collections.abc import Sequence
from dataclasses import dataclass

from tms_sim.arm import Arm
from tms_sim.motion import Motion, Verdict
from tms_sim.path import Path, Point, refusal

TOLERANCE = 0.03  # rad, at the end of a goal
STOPPED = 0.01  # rad/s, at the end of a goal
GOAL_TIME = 60.0  # s after the end in which the arm may still arrive
SUCCESSFUL, INVALID_GOAL, PATH_VIOLATED, GOAL_VIOLATED = 0, -1, -4, -5  # control_msgs result codes


@dataclass
class PathMotion(Motion):
    """One trajectory goal."""

    path: Path
    goal_time: float  # s


class Controller:
    """Turns goals into motion of the arm. Safe to call from several threads."""

    def __init__(self, arm: Arm) -> None:
        self.arm = arm
        self.emergency = False
        self._motion: PathMotion | None = None
        self._braking: Verdict | None = None  # verdict of the motion once the arm stands
        self._lock = arm.lock

    @property
    def busy(self) -> bool:
        """Whether a goal is open."""
        return self._motion is not None

    def refusal(self, names: Sequence[str], points: Sequence[Point]) -> tuple[int, str] | None:
        """Result code and reason of a goal's refusal, or None."""
        if self.emergency:
            return INVALID_GOAL, "the emergency stop is on: publish false on emg_stop to release it"
        return refusal(self.arm.joints, names, points)

    def begin(self, names: Sequence[str], points: Sequence[Point], goal_time: float = 0.0) -> PathMotion:
        """Follow a trajectory that was not refused; a motion under way is preempted."""
        with self._lock:
            if self._motion is not None:
                self._motion.end(Verdict("ABORTED", INVALID_GOAL, "preempted by a newer goal"))
            motion = PathMotion(self.arm.follow(names, points), goal_time or GOAL_TIME)
            self._motion, self._braking = motion, None
            if self.emergency:  # pressed between the check and now
                self._brake(Verdict("ABORTED", PATH_VIOLATED, "emergency stop"))
            return motion

    def cancel(self, motion: PathMotion) -> None:
        """Brake; the motion ends CANCELED once the arm stands."""
        with self._lock:
            if motion is self._motion:
                self._brake(Verdict("CANCELED", SUCCESSFUL, "stopped on request"))

    def stop(self, on: bool) -> None:
        """Set the level of the emergency stop: while true, goals are refused. The caller stops the arm."""
        with self._lock:
            self.emergency = on
            if on and self._braking is None:
                self._braking = Verdict("ABORTED", PATH_VIOLATED, "emergency stop")

    def _brake(self, verdict: Verdict) -> None:
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

    def _leave(self, verdict: Verdict) -> None:
        if verdict.outcome == "SUCCEEDED":
            self.arm.finish()
        elif self._braking is None:
            self.arm.hold()

    def _ended(self, motion: PathMotion) -> Verdict | None:
        if self._braking is not None:
            return self._braking if self.arm.stands else None
        late = self.arm.elapsed - motion.path.duration
        if late < 0:
            return None
        apart = [abs(q - end) for q, end in zip(self.arm.positions, motion.path.end, strict=True)]
        if max(apart) <= TOLERANCE and all(abs(velocity) <= STOPPED for velocity in self.arm.velocities):
            return Verdict("SUCCEEDED")
        if late <= motion.goal_time:
            return None
        name = list(self.arm.joints)[apart.index(max(apart))]
        text = f"{name} is {max(apart):.3f} rad off its goal {motion.goal_time:.0f} s after its time"
        return Verdict("ABORTED", GOAL_VIOLATED, text)
