"""Where machines stand in the map, from /tf and /tf_static; a machine's Nav2 puts `odom` between the two."""

import math
from collections.abc import Callable, Iterable
from typing import NamedTuple

from tf2_msgs.msg import TFMessage

from tms_config.clock import monotonic
from tms_machine.geometry import yaw_of

MAP = "map"


class FramePose(NamedTuple):
    """Where a frame is in another one, and when that was received last."""

    x: float  # m
    y: float  # m
    yaw: float  # rad
    received: float  # monotonic, s; infinite for fixed frames


class Frames:
    """Keeps the last place of the given frames, and of the frames between them and the map."""

    def __init__(self, frames: Iterable[str], clock: Callable[[], float] = monotonic) -> None:
        self._wanted, self._clock = set(frames), clock
        self._seen: dict[str, tuple[str, FramePose]] = {}  # frame -> its parent, and its place in the parent

    def receive(self, message: TFMessage) -> set[str]:
        """Take a tf2_msgs/TFMessage of /tf; returns the frames of interest in it."""
        return self._take(message, self._clock())

    def receive_fixed(self, message: TFMessage) -> None:
        """Take a message of /tf_static."""
        self._take(message, math.inf)

    def _take(self, message: TFMessage, received: float) -> set[str]:
        reported = set()
        for one in message.transforms:
            at, q = one.transform.translation, one.transform.rotation
            turn = (q.x, q.y, q.z, q.w)
            if not all(map(math.isfinite, (at.x, at.y, *turn))):
                continue  # a localisation without a fix
            # A fixed frame is published only once, maybe before it is wanted.
            if one.child_frame_id in self._wanted or received == math.inf:
                self._seen[one.child_frame_id] = one.header.frame_id, FramePose(at.x, at.y, yaw_of(turn), received)
                self._wanted.add(one.header.frame_id)
                reported.add(one.child_frame_id)
        return reported

    def place(self, frame: str) -> FramePose | None:
        """Its place in the map, as old as the oldest transform used; None if the frames do not lead to the map."""
        x, y, yaw, received = 0.0, 0.0, 0.0, math.inf
        passed = set[str]()
        while frame != MAP:
            if frame in passed or frame not in self._seen:
                return None
            passed.add(frame)
            frame, step = self._seen[frame]
            cos, sin = math.cos(step.yaw), math.sin(step.yaw)
            x, y, yaw = step.x + x * cos - y * sin, step.y + x * sin + y * cos, yaw + step.yaw
            received = min(received, step.received)
        return FramePose(x, y, math.remainder(yaw, math.tau), received)
