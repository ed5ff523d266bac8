"""Where frames stand in the map, as /tf tells; a machine's Nav2 puts `odom` between the map and the machine."""

import math
from collections.abc import Iterable
from typing import Any

MAP = "map"
Place = tuple[float, float, float]  # x m, y m, yaw rad


class Frames:
    """Keeps the last place of the given frames, and of those between them and the map; nobody needs the others."""

    def __init__(self, frames: Iterable[str]) -> None:
        self._wanted = set(frames)
        self._seen: dict[str, tuple[str, Place]] = {}  # frame -> its parent, and where it is in that

    def hear(self, message: Any) -> set[str]:
        """Take a tf2_msgs/TFMessage; the frames that it told of."""
        told = set()
        for one in message.transforms:
            at, q = one.transform.translation, one.transform.rotation
            if one.child_frame_id not in self._wanted or not all(map(math.isfinite, (at.x, at.y, q.x, q.y, q.z, q.w))):
                continue  # also a localisation without a fix
            yaw = math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))
            self._seen[one.child_frame_id] = one.header.frame_id, (at.x, at.y, yaw)
            self._wanted.add(one.header.frame_id)
            told.add(one.child_frame_id)
        return told

    def place(self, frame: str) -> Place | None:
        """In the map; None as long as /tf does not lead there."""
        x = y = yaw = 0.0
        passed = set[str]()
        while frame != MAP:
            if frame in passed or frame not in self._seen:
                return None
            passed.add(frame)
            frame, (px, py, turn) = self._seen[frame]
            x, y = px + x * math.cos(turn) - y * math.sin(turn), py + x * math.sin(turn) + y * math.cos(turn)
            yaw += turn
        return x, y, math.remainder(yaw, math.tau)
