"""Drives the tracks of one machine: hears where it is, and commands speeds at 20 Hz while a goal is open."""

import math
import threading
from collections.abc import Callable, Sequence
from typing import Any

from geometry_msgs.msg import Twist
from prometheus_client import Gauge
from std_msgs.msg import Float64

from tms_config.clock import monotonic
from tms_config.models import DRIVE, Drive
from tms_control.detour import Question
from tms_control.from_above import arm_from_above
from tms_control.ground import Ground, Outline
from tms_control.links import Links
from tms_control.machine_clock import MachineClock
from tms_control.path import Pose
from tms_control.planner import Goal, Pace
from tms_control.track_estimate import Command, PoseSample, TrackEstimate
from tms_control.trip import Trip
from tms_control.trip_task import Task
from tms_decision.permit_link import LEASE
from tms_machine import stamps
from tms_machine.border import speed_limit
from tms_machine.places import POSES, place_of
from tms_mc.gateway_watch import GatewayWatch
from tms_mc.joints import Joints
from tms_mc.reasons import ControllerStood, PosesSilent, PosesUnheard
from tms_mc.turns import Turns
from tms_reason.reason import Reason
from tms_ros.topics import Arrival
from tms_runtime.app import App

YAW_GAIN = Gauge("tms_mc_yaw_gain", "Yaw rate of the tracks as a part of the one commanded, as learned from turns")

PERIOD = 0.05  # s between commands
DEPTH = 10  # messages that may come between two looks
SILENT = 0.5  # s without a pose after which no goal is taken


class Tracks:
    """One goal at a time. Safe to call from several threads."""

    def __init__(self, app: App, gateway: GatewayWatch, drive: Drive, joints: Joints) -> None:
        site, machine = app.site, app.machine
        border = site.border(machine)
        self._app, self._gateway, self._drive = app, gateway, drive
        self._response = site.model_of(machine).responses(border)[DRIVE]
        self._model, self._joints = site.model_of(machine), joints
        self._outline, self._links = Outline.of(self._model), Links(self._model)
        self._topic, source = f"/{machine}/{border.pose}", border.sources["pose"]
        kind = POSES[source.message]
        self._heard: Callable[[], list[Arrival[Any]]] = app.ros.sample_arrivals(kind, self._topic, DEPTH)
        self._cmd_vel = app.ros.publisher(Twist, f"/{machine}/{border.cmd_vel}", 1)
        self._clock, self._estimate = MachineClock(), TrackEstimate(self._response)
        self._trip: Trip | None = None
        self._fastest = math.inf  # m/s, as the gateway says
        app.ros.subscribe(Float64, speed_limit(machine), self._limited, latched=True)
        self._lock = threading.RLock()  # guards the trip and the estimate
        self._turns = Turns(app.ros, self._step, PERIOD, "tracks")

    def unready(self) -> Reason | None:
        """What keeps it from driving, or None."""
        with self._lock:
            silent = self._clock.silent(monotonic())
        if math.isinf(silent):
            return PosesUnheard(self._topic)
        return PosesSilent(silent, self._topic) if silent > SILENT else None

    @property
    def stands(self) -> bool:
        """Whether the machine was seen to stand."""
        with self._lock:
            return self._clock.stamp is not None and self._estimate.at(self._time()).stands

    @property
    def pose(self) -> Pose:
        """Where it is now."""
        with self._lock:
            return self._estimate.at(self._time()).pose

    def question(self, start: Pose, goals: Sequence[Goal], ground: Ground) -> Question:
        """How a path from a pose through goals is asked for, of the place whose pose is told."""
        with self._lock:
            pace = Pace.of(self._drive, self._estimate.yaw_gain)
        return Question(start, tuple(goals), pace, 0.0, self._outline, ground, self._with_arm())

    def _with_arm(self) -> Outline | None:
        """The outline with what joints move beside it, as they were told to be last; None where that is not known."""
        if self._joints.unready() is not None:
            return None
        return self._outline.with_arm(arm_from_above(self._model, self._links, self._joints.positions))

    def begin(self, task: Task, ground: Ground) -> Trip:
        """Drive, from where the machine is, among what stands on the ground; an open goal ends."""
        arm = self._with_arm()
        with self._lock:
            now = self._time()
            if self._trip is not None:
                self._trip.silence(now)
            trip = self._trip = Trip(task, self._drive, self._estimate, now, self._outline, ground, arm)
        self._turns.wake()
        return trip

    def look(self, trip: Trip, ground: Ground) -> None:
        """Have a goal see what stands around now, and search the way that it has asked for: up to some seconds."""
        with self._lock:
            trip.see(self._time(), ground)
            asked = trip.asked
        if asked is not None:
            found = asked.answer(lambda: not trip.waits_for(asked))
            if found is not None:
                with self._lock:
                    trip.answer(self._time(), found)

    def told(self, trip: Trip) -> Any:
        """What the feedback of a goal tells."""
        with self._lock:
            return trip.feedback(self._time())

    def stop(self, trip: Trip | None = None) -> None:
        """End a goal, or the open one: with a gateway, it brakes and nothing is sent; without, it ramps down here."""
        with self._lock:
            trip = trip or self._trip
            if trip is None or trip.verdict is not None:
                return
            self._app.log.info("stopping", gateway=self._gateway.alive)
            if self._gateway.alive:
                trip.silence(self._time())
            else:
                trip.cancel()

    def _limited(self, speed: Float64) -> None:
        self._fastest = speed.data

    def _time(self) -> float:
        """The machine's time [s]; only after it was heard of."""
        return self._clock.time(monotonic())

    def _step(self, gap: float) -> bool:
        """Take what was heard, and command what is due, `gap` [s] after the last time; whether a goal is open."""
        with self._lock:
            samples = [sample for arrival in self._heard() if (sample := self._sample(arrival)) is not None]
            trip = self._trip
            if trip is None or trip.verdict is not None:
                for sample in samples:
                    self._estimate.measured(sample)
                return False
            if gap > LEASE:  # by now the gateway has stopped the machine
                self._app.log.warning("stopping", reason=ControllerStood(gap))
                trip.silence(self._time())
                return False
            if not self._gateway.alive:
                trip.cancel()
            for sample in samples[:-1]:
                self._estimate.measured(sample)
            trip.limit(self._fastest)
            self._send(trip.step(self._time(), samples[-1] if samples else None))
            YAW_GAIN.set(self._estimate.yaw_gain)
            return True

    def _send(self, command: Command | None) -> None:
        if command is not None:
            twist = Twist()
            twist.linear.x, twist.angular.z = command.v, command.w
            self._cmd_vel.publish(twist)

    def _sample(self, arrival: Arrival[Any]) -> PoseSample | None:
        """A pose in the map, with the machine's time; None where it says nothing."""
        place = place_of(arrival.message)
        if place is None:
            return None
        stamp = stamps.seconds(arrival.message.header.stamp)
        if not self._clock.hear(arrival.received, stamp):
            self._begin_anew()
        return PoseSample(stamp, Pose(*place))

    def _begin_anew(self) -> None:
        """The clock was set back: no time before counts any more."""
        if self._trip is not None:
            self._trip.silence(self._time())
            self._trip = None
        self._estimate = TrackEstimate(self._response)
