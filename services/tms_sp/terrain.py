"""Terrain that sensing PCs measure: clouds of points become heights for tms:ground."""

import numpy as np
from numpy.typing import NDArray
from sensor_msgs.msg import PointCloud2, PointField
from tms_msg_ground.msg import HeightPatch
from tms_msg_sp.msg import InputState

from tms_config.clock import monotonic, unix_time
from tms_machine.sensing import TerrainInput
from tms_machine.stamps import seconds
from tms_reason.reason import Reason
from tms_reason.wire import to_line
from tms_runtime.app import App
from tms_soil.patches import patch
from tms_soil.scanning import gathered
from tms_soil.surface import Array
from tms_sp.arrivals import Arrivals
from tms_sp.clock import SourceClock
from tms_sp.inputs import MESSAGES
from tms_sp.mapping import MessageRefused
from tms_sp.reasons import CloudFrame, CloudNotPoints

SEEN = "/tms/ground/seen"
FRAME = "map"
AXES = ("x", "y", "z")
TYPES = {PointField.FLOAT32: "f4", PointField.FLOAT64: "f8"}


class TerrainSensing:
    """One topic with clouds; used on the executor thread."""

    def __init__(self, app: App, name: str, given: TerrainInput, clock_limit: float) -> None:
        self.name, self.given = name, given
        self._log, self._clock, self._arrivals = app.log, SourceClock(clock_limit), Arrivals(given.hz)
        self._stamp: float | None = None  # s since 1970, of the last cloud that was taken
        self._accepted = self._refused = 0
        self._why: Reason | None = None
        self._patches = app.ros.publisher(HeightPatch, SEEN, depth=5)
        app.ros.subscribe(PointCloud2, given.topic, self.receive, depth=2, best_effort=given.reliability != "reliable")

    def receive(self, cloud: PointCloud2) -> None:
        """Take a cloud."""
        try:
            message = self._heights(cloud)
        except MessageRefused as refusal:
            self._refused += 1
            if refusal.reason != self._why:
                self._why = refusal.reason
                self._log.warning("refused", input=self.name, refused=self._refused, reason=refusal.reason)
            MESSAGES.labels(self.name, refusal.code).inc()
            return
        self._patches.publish(message)
        self._accepted += 1
        self._arrivals.add(monotonic())
        MESSAGES.labels(self.name, "accepted").inc()

    def _heights(self, cloud: PointCloud2) -> HeightPatch:
        """The heights of a cloud.

        Raises:
            MessageRefused: it is in another frame, no cloud, from the future, or older than the last one.
        """
        if cloud.header.frame_id != FRAME:
            raise MessageRefused(CloudFrame(cloud.header.frame_id))
        stamp, now = seconds(cloud.header.stamp), unix_time()
        self._clock.check(stamp, self._stamp, now)
        try:
            found = patch(gathered(points(cloud), self.given.cell))
        except ValueError as error:
            raise MessageRefused(CloudNotPoints(str(error))) from error
        self._clock.age(stamp, now)
        self._stamp, found.header.stamp = stamp, cloud.header.stamp
        return found

    def state(self) -> InputState:
        """The message for the topic of input states."""
        now = monotonic()
        return InputState(
            name=self.name, topic=self.given.topic, type="sensor_msgs/msg/PointCloud2", hz_expected=self.given.hz,
            hz=self._arrivals.rate(now), state=self._arrivals.state(now, self._clock.off), age=self._arrivals.age(now),
            clock_offset=_or_nan(self._clock.offset),
            accepted=self._accepted, written=self._accepted, refused=self._refused, last_refusal=to_line(self._why),
        )  # fmt: skip


def points(cloud: PointCloud2) -> Array:
    """The points of a cloud [m], N x 3.

    Raises:
        ValueError: it has no x, y and z as floating-point numbers, or its sizes contradict each other.
    """
    fields = {one.name: one for one in cloud.fields if one.name in AXES and one.datatype in TYPES}
    if len(fields) != len(AXES):
        raise ValueError("no x, y, z")
    order = ">" if cloud.is_bigendian else "<"
    if len(cloud.data) != cloud.row_step * cloud.height or cloud.row_step != cloud.point_step * cloud.width:
        raise ValueError(f"{len(cloud.data)} bytes of {cloud.width} x {cloud.height} points")
    kind = np.dtype({
        "names": list(AXES), "formats": [order + TYPES[fields[axis].datatype] for axis in AXES],
        "offsets": [fields[axis].offset for axis in AXES], "itemsize": cloud.point_step,
    })  # fmt: skip
    found: NDArray[np.void] = np.frombuffer(cloud.data, dtype=kind)
    return np.column_stack([found[axis].astype(np.float64) for axis in AXES])


def _or_nan(value: float | None) -> float:
    return float("nan") if value is None else value
