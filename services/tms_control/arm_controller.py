"""Moves the joints of a machine along trajectories, one goal at a time. Pure logic.

Joints answer after different dead times. The reference of a goal begins the longest of them after the goal was taken,
and each joint is sent what is due a dead time of its own later: so all of them are on the reference at the same time.
"""

from collections.abc import Mapping

from tms_config.models import Joint, Response
from tms_control.arm_motion import (
    GOAL_VIOLATED,
    PATH_VIOLATED,
    STOPPED,
    TOLERANCE,
    ArmMotion,
    Tolerances,
    limit,
)
from tms_control.drive_estimate import Fit
from tms_control.joint_servo import PERIOD, JointServo
from tms_control.reasons import OffReference, ShortOfGoal, TakenOver
from tms_control.reference_trajectory import ReferenceTrajectory
from tms_control.verdict import Ending, Verdict
from tms_reason.reason import Reason

ENDLESS = float("inf")
PLAYS_ON = 0.2  # s more than its dead time until a drive shows what the last command does


class ArmController:
    """Every call gives the time of the machine [s]; angles are rad."""

    def __init__(self, joints: Mapping[str, Joint], response: Mapping[str, Response]) -> None:
        """`joints` in the order of trajectories; passive ones are never commanded."""
        self.joints = joints
        self.servos = {name: JointServo(one, response[name]) for name, one in joints.items() if not one.passive}
        self._numbers = {name: number for number, name in enumerate(joints)}  # in references
        self.learned: dict[str, Fit] = {}  # what the last goal has shown of the drives
        self._motion: ArmMotion | None = None
        self._braking: Verdict | None = None  # of the motion, once the joints stand
        self._silent: float | None = None  # s, since when somebody else has the drives

    @property
    def busy(self) -> bool:
        """Whether a goal is open."""
        return self._motion is not None

    @property
    def stands(self) -> bool:
        """Whether all joints were measured to stand."""
        return all(abs(servo.velocity) <= STOPPED for servo in self.servos.values())

    @property
    def _dead_time(self) -> float:
        """The longest of the joints [s]."""
        return max(servo.dead_time for servo in self.servos.values())

    def measured(self, at: float, positions: Mapping[str, float], velocities: Mapping[str, float]) -> None:
        """Take a measurement of all joints; times only go on."""
        for name, servo in self.servos.items():
            servo.measured(at, positions[name], velocities[name])

    def begin(self, now: float, reference: ReferenceTrajectory, tolerances: Tolerances) -> ArmMotion:
        """Follow a reference that begins where the joints are; an open goal ends."""
        self._end(Verdict(Ending.ABORTED, TakenOver()))
        for servo in self.servos.values():
            servo.begin()
        self._motion = ArmMotion(reference, tolerances, now + self._dead_time)
        return self._motion

    def cancel(self, now: float, verdict: Verdict) -> None:
        """Ramp down, and hold; the goal ends with the verdict once the joints stand.

        After `silence`: hold the joints where they are, since nobody else does.
        """
        if self._motion is not None and (self._braking is None or self._silent is not None):
            self._braking, self._silent = self._braking or verdict, None
            for servo in self.servos.values():
                servo.brake(now)

    def silence(self, now: float, verdict: Verdict) -> None:
        """Send nothing from now on: somebody else has the drives. The goal ends once the joints stand."""
        if self._motion is not None and self._silent is None:
            self._braking, self._silent = verdict, now
        for servo in self.servos.values():
            servo.silence()

    def abandon(self, verdict: Verdict) -> None:
        """End the goal at once, and forget all times: the clock of the machine was set back."""
        for servo in self.servos.values():
            servo.silence()
        self._end(verdict)

    def step(self, now: float) -> dict[str, float]:
        """The angles to send now, by joint; none without a goal. May end the goal."""
        motion = self._motion
        if motion is None:
            return {}
        if self._silent is not None and self._braking is not None:
            self._watch(now - self._silent, self._braking)
            return {}
        if self._braking is not None:
            return self._slow_down(now, self._braking)
        since = now - motion.begun
        sent = {name: self._follow(name, motion.reference, now, since) for name in self.servos}
        if (off := self._off_path(motion, since)) is not None:
            self.cancel(now, Verdict(Ending.ABORTED, off, PATH_VIOLATED))
        elif since >= motion.reference.duration:
            self._arrive(now, motion, since - motion.reference.duration)
        return sent

    def _follow(self, name: str, reference: ReferenceTrajectory, now: float, since: float) -> float:
        servo, number = self.servos[name], self._numbers[name]
        ahead = since + servo.dead_time
        return servo.follow(now, reference.joint(number, ahead), reference.joint(number, ahead + PERIOD))

    def _slow_down(self, now: float, verdict: Verdict) -> dict[str, float]:
        sent = {name: servo.slow_down(now) for name, servo in self.servos.items()}
        if self.stands and all(servo.braked(now) for servo in self.servos.values()):
            self._end(verdict)
        return sent

    def _watch(self, since: float, verdict: Verdict) -> None:
        """End the goal when the joints stand, and what was sent before cannot move them any more."""
        if self.stands and since > PLAYS_ON + self._dead_time:
            self._end(verdict)

    def _off_path(self, motion: ArmMotion, since: float) -> Reason | None:
        """Which joint is further from the reference than its goal allows."""
        for name, servo in self.servos.items():
            allowed = limit(motion.tolerances.path, name, ENDLESS)
            if since >= 0.0 and allowed < ENDLESS:
                off = abs(servo.position - motion.reference.joint(self._numbers[name], since))
                if off > allowed:
                    return OffReference(name, off, allowed)
        return None

    def _arrive(self, now: float, motion: ArmMotion, late: float) -> None:
        allowed = motion.tolerances
        away = {name: self._away(name, motion) for name in self.servos}
        near = all(off <= limit(allowed.goal, name, TOLERANCE) for name, off in away.items())
        slow = all(abs(one.velocity) <= limit(allowed.stopped, name, STOPPED) for name, one in self.servos.items())
        if near and slow:
            self.learned = {name: fit for name, servo in self.servos.items() if (fit := servo.end()) is not None}
            self._end(Verdict(Ending.SUCCEEDED))
        elif late > motion.goal_time:
            worst = max(away, key=lambda name: away[name])
            self.cancel(now, Verdict(Ending.ABORTED, ShortOfGoal(worst, away[worst], late), GOAL_VIOLATED))

    def _away(self, name: str, motion: ArmMotion) -> float:
        return abs(self.servos[name].position - motion.reference.end[self._numbers[name]])

    def _end(self, verdict: Verdict) -> None:
        if self._motion is not None:
            self._motion.verdict = verdict
        self._motion = self._braking = self._silent = None
