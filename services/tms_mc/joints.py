"""Moves the joints of one machine: hears where they are, and commands angles at 50 Hz while a goal is open."""

import math
import threading
from collections.abc import Sequence

from prometheus_client import Gauge
from sensor_msgs.msg import JointState

from tms_config.clock import monotonic
from tms_config.models import DRIVE
from tms_control.arm_controller import ArmController
from tms_control.arm_motion import ArmMotion, Tolerances
from tms_control.machine_clock import MachineClock
from tms_control.reference_trajectory import Knot, ReferenceTrajectory
from tms_control.verdict import Ending, Verdict
from tms_decision.permit_link import LEASE
from tms_machine import stamps
from tms_machine.joint_commands import JointCommands
from tms_mc.gateway_watch import GatewayWatch
from tms_mc.reasons import (
    ClockSetBack,
    ControllerStood,
    GatewayGone,
    JointMissing,
    JointsNotHeard,
    JointsSilent,
    NoCommandTopic,
)
from tms_mc.turns import Turns
from tms_reason.reason import Reason
from tms_ros.topics import Arrival
from tms_runtime.app import App

DEAD_TIME = Gauge("tms_mc_dead_time_seconds", "Until a command shows, as learned from moves", ["joint"])
LAG = Gauge("tms_mc_lag_seconds", "Time constant of the answer to a command, as learned from moves", ["joint"])
DROOP = Gauge("tms_mc_droop_radians", "How far a joint stays short of its command, as learned from moves", ["joint"])

PERIOD = 0.02  # s between commands
DEPTH = 20  # messages that may come between two looks: 50 Hz and some to spare
SILENT = 0.8  # s without joint states after which the joints are braked; the gateway stops the machine after 1 s


class Joints:
    """One goal at a time. Safe to call from several threads."""

    def __init__(self, app: App, gateway: GatewayWatch) -> None:
        site, machine = app.site, app.machine
        model, border = site.model_of(machine), site.border(machine)
        self._app, self._gateway = app, gateway
        response = {name: one for name, one in model.responses(border).items() if name != DRIVE}
        self.arm = ArmController(model.joints, response)
        self._names = {border.joints.get(name, name): name for name in model.joints}
        self._topic = f"/{machine}/{border.joint_states}"
        self._heard = app.ros.sample_arrivals(JointState, self._topic, DEPTH)
        self._commands = JointCommands(app.ros, machine, border)
        self._clock = MachineClock()
        self._positions: dict[str, float] = {}
        self._velocities: dict[str, float] = {}
        self._lock = threading.RLock()  # guards the controller and what is measured
        self._turns = Turns(app.ros, self._step, PERIOD, "joints")

    def unready(self) -> Reason | None:
        """What keeps it from moving the joints, or None."""
        for joint in self.arm.servos:
            if not self._commands.reaches(joint):
                return NoCommandTopic(joint)
        with self._lock:
            silent = self._clock.silent(monotonic())
            missing = [name for name in self.arm.servos if name not in self._positions]
        if math.isinf(silent):
            return JointsNotHeard(self._topic)
        if silent > SILENT:
            return JointsSilent(silent, self._topic)
        return JointMissing(missing[0], self._topic) if missing else None

    @property
    def positions(self) -> dict[str, float]:
        """The last angles [rad] of all joints of the model; joints that nothing moves may be missing: they are 0."""
        with self._lock:
            return {name: self._positions.get(name, 0.0) for name in self.arm.joints}

    @property
    def stands(self) -> bool:
        """Whether all joints were measured to stand."""
        with self._lock:
            return self.arm.stands

    def begin(self, names: Sequence[str], points: Sequence[Knot], tolerances: Tolerances) -> ArmMotion:
        """Follow a trajectory from where the joints are."""
        with self._lock:
            now = self.positions
            start = Knot(0.0, tuple(now.values()), tuple(0.0 for _ in now))
            reference = ReferenceTrajectory(self.arm.joints, start, names, points)
            motion = self.arm.begin(self._time(), reference, tolerances)
        self._turns.wake()
        return motion

    def since(self, motion: ArmMotion) -> float:
        """How long the reference of a goal has been followed [s]; below 0 before it begins."""
        with self._lock:
            return self._time() - motion.begun

    def stop(self, why: Reason | None, ending: Ending = Ending.CANCELED) -> None:
        """End the open goal: with a gateway, it holds the joints and nothing is sent; without, they are braked here."""
        verdict = Verdict(ending, why)
        with self._lock:
            if not self.arm.busy:
                return
            self._app.log.info("stopping", reason=why, gateway=self._gateway.alive)
            if self._gateway.alive:
                self.arm.silence(self._time(), verdict)
            else:
                self.arm.cancel(self._time(), verdict)

    def _time(self) -> float:
        """The machine's time [s]; only after it was heard of."""
        return self._clock.time(monotonic())

    def _step(self, gap: float) -> bool:
        """Take what was heard, and command what is due, `gap` [s] after the last time; whether a goal is open."""
        with self._lock:
            for arrival in self._heard():
                self._measured(arrival)
            if not self.arm.busy:
                return False
            if gap > LEASE:  # by now the gateway has stopped the machine
                self._app.log.warning("stopping", reason=ControllerStood(gap))
                self.arm.silence(self._time(), Verdict(Ending.ABORTED, ControllerStood(gap)))
            elif (lost := self._lost()) is not None:
                self.arm.cancel(self._time(), Verdict(Ending.ABORTED, lost))
            angles = self.arm.step(self._time())
            if angles:
                self._commands.send(angles)
            self._tell()
            return True

    def _tell(self) -> None:
        """Say what a goal that has just ended has shown of the drives."""
        learned, self.arm.learned = self.arm.learned, {}
        for joint, fit in learned.items():
            DEAD_TIME.labels(joint).set(fit.dead_time)
            LAG.labels(joint).set(fit.lag)
            DROOP.labels(joint).set(fit.droop)
            self._app.log.info("learned", joint=joint, dead_time=fit.dead_time, lag=fit.lag, droop=fit.droop)

    def _lost(self) -> Reason | None:
        """Without what the machine must not be moved any more."""
        if not self._gateway.alive:
            return GatewayGone()
        silent = self._clock.silent(monotonic())
        late = self._app.pulse.late()  # this process itself did not run
        return JointsSilent(silent, self._topic) if silent > SILENT and not late else None

    def _measured(self, arrival: Arrival[JointState]) -> None:
        message = arrival.message
        for i, name in enumerate(message.name):
            joint = self._names.get(name)
            if joint is not None and i < len(message.position) and i < len(message.velocity):
                if math.isfinite(message.position[i]) and math.isfinite(message.velocity[i]):
                    self._positions[joint], self._velocities[joint] = message.position[i], message.velocity[i]
        stamp = stamps.seconds(message.header.stamp)
        before = self._clock.stamp
        if not self._clock.hear(arrival.received, stamp):
            self.arm.abandon(Verdict(Ending.ABORTED, ClockSetBack()))
        elif stamp == before:
            return
        if all(name in self._positions for name in self.arm.servos):
            self.arm.measured(stamp, self._positions, self._velocities)
