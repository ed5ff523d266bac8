"""Publishes sources and frames of a stand-in from one timer, since a timer costs more than the work in it.

25 Hz is the rate of the simulator's excavators. Velocities are those of the machine, also when its time runs faster
than real time. Faults of the sources do not change the frames, which a real site gets from elsewhere.
"""

from typing import Any

from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
from tf2_msgs.msg import TFMessage

from tms_config.clock import monotonic, unix_ns
from tms_runtime.app import App
from tms_sim.frames import Chain, LinkTransform
from tms_sim.impostor import Impostor
from tms_sim.machine import StandIn
from tms_sim.sensor_model import Reading, SensorModel
from tms_sim.sources import Topic, time_of, topics
from tms_sim.truth import Truth
from tms_sim.way_teller import WayTeller

STEP_PERIOD = 0.04  # s
TF_EVERY = 2  # periods a set of frames while something moves
TF_STILL = 10  # periods while it stands: each set costs every subscriber
LAG = 0.5  # s at most that are made up for after the process was held up
REPLAYED = 2.0  # s of the machine


class Telemetry:
    """Lets the machine's time pass, and publishes its motion."""

    def __init__(self, app: App, machine: StandIn, name: str) -> None:
        border, model, ros = app.site.border(name), app.site.model_of(name), app.ros
        self._machine, self._speed = machine, app.site.file.sim.speed
        self._chain = Chain(model, border)
        self._origin = (machine.base.x, machine.base.y, machine.base.yaw) if machine.base else app.site.start_of(name)
        joints = list(machine.arm.joints)

        def made() -> list[Topic]:
            return topics(ros, name, border, joints, self._origin, lambda: machine.fault.mute, begun)

        begun = unix_ns()
        self._topics = made()
        self._sensors = SensorModel(round(REPLAYED / (STEP_PERIOD * self._speed)))
        self._impostor = Impostor(ros, made)
        self._ways = WayTeller(ros, name, machine.base) if machine.base else None
        self._truth = Truth(ros, name, machine)
        self._tf = ros.publisher(TFMessage, "/tf")
        self._frames = TFMessage()
        self._reported: Any = None  # place and joints of the frames
        self._stepped, self._ticks = monotonic(), 0

    def tick(self) -> None:
        """Let the machine's time catch up with ours, and publish. The timer calls this."""
        now, measured = monotonic(), unix_ns()
        self._machine.step(min(now - self._stepped, LAG) * self._speed)
        self._stepped = now
        self._truth.publish()
        self._ticks += 1
        reading = self._read(measured)
        reported = self._sensors.apply(reading, self._machine.fault)
        for topic in self._topics:
            if topic.due(self._ticks, STEP_PERIOD):
                topic.publish(reported)
        if self._ways is not None:
            self._ways.tell(self._ticks)
        self._impostor.switch(reported, self._machine.fault.second_publisher)
        if self._ticks % TF_EVERY == 0:
            self._publish_frames(reading)

    def _read(self, measured: int) -> Reading:
        arm, base = self._machine.arm, self._machine.base
        place = (base.x, base.y, base.yaw) if base else self._origin
        speeds = (base.v + base.leak, base.w) if base else (0.0, 0.0)
        return Reading(measured, tuple(arm.positions), tuple(arm.velocities), place, speeds,
                       self._machine.ground.stance)  # fmt: skip

    def _publish_frames(self, reading: Reading) -> None:
        now = (reading.place, reading.positions, reading.stands)
        if now == self._reported and self._ticks % TF_STILL:
            return
        if now != self._reported:
            joints = dict(zip(self._machine.arm.joints, reading.positions, strict=True))
            frames = self._chain.frames(reading.place, joints, reading.stands)
            self._frames, self._reported = TFMessage(transforms=[_transform(frame) for frame in frames]), now
        stamp = time_of(reading.stamp)
        for transform in self._frames.transforms:
            transform.header.stamp = stamp
        self._tf.publish(self._frames)


def _transform(frame: LinkTransform) -> TransformStamped:
    x, y, z = frame.xyz
    qx, qy, qz, qw = frame.turn
    found = TransformStamped(child_frame_id=frame.child)
    found.header.frame_id = frame.parent
    found.transform = Transform(translation=Vector3(x=x, y=y, z=z), rotation=Quaternion(x=qx, y=qy, z=qz, w=qw))
    return found
