"""Keeps commands from a simulator that has just begun, until its machines have come to where they start.

OperaSim-PhysX begins with all joints at 0, beyond the limits of some, and drives them to where its scene has them. What
stops or holds them in these seconds would keep them there, and nothing could move them from there. Nothing of ours
moves a machine then: no command is under way in a simulator that has just begun. The last order to stop is sent
afterwards, all other commands are dropped. A simulator that was only disconnected gets its stop at once, as its first
stamp tells.
"""

import threading
from collections.abc import Callable

SETTLES = 6.0  # s of the simulator until its machines stand
UNKNOWN = 0.3  # s that a client may take to tell its time; then its stop is not kept any longer


class FreshStart:
    """For one client. `send` passes a stop on; times are monotonic seconds, stamps seconds of the client's clock."""

    def __init__(self, send: Callable[[str, bytes], None], now: float) -> None:
        self._send, self._begun = send, now
        self._stamp: float | None = None
        self._kept: dict[str, bytes] = {}
        self._lock = threading.Lock()  # guards the stops that are kept

    def stop(self, topic: str, data: bytes, now: float) -> None:
        """Pass an order to stop on, or to release, or keep it as the last one of its topic."""
        with self._lock:
            if self._settling(now):
                self._kept[topic] = data
                return
        self._send(topic, data)

    def young(self) -> bool:
        """Whether the simulator is known to have just begun: commands are dropped."""
        return self._stamp is not None and self._stamp < SETTLES

    def told(self, stamp: float, now: float) -> None:
        """Take a stamp of the client; 0 says nothing."""
        if stamp > 0.0:
            self._stamp = stamp
        self.look(now)

    def look(self, now: float) -> None:
        """Pass on what was kept, if it is time."""
        with self._lock:
            if not self._kept or self._settling(now):
                return
            kept, self._kept = self._kept, {}
        for topic, data in kept.items():
            self._send(topic, data)

    def _settling(self, now: float) -> bool:
        return now - self._begun < UNKNOWN if self._stamp is None else self._stamp < SETTLES
