"""Publishes the messages of a recording at their moments."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from tms_cli.reasons import NobodyListens, TwoSources
from tms_cli.replay.matching import Matches
from tms_cli.replay.pace import Pace
from tms_cli.replay.recording import Recording, Track
from tms_cli.replay.stamps import Stamps
from tms_config.clock import monotonic, sleep
from tms_reason.errors import TmsError
from tms_sensors.message_types import message_class

if TYPE_CHECKING:
    from tms_ros.node import Ros

READER_LIMIT = 10.0  # s for tms:sp to subscribe to the topics
LAST_LIMIT = 5.0  # s for the last messages to arrive
DEPTH = 1000  # messages that may wait for a reader
SLICE = 0.2  # s between updates of the progress while no message is due
LOOP_GAP = 0.5  # s between the end and the next beginning; longer than stamps differ from their moments


@dataclass
class Played:
    """Counts of the replay so far."""

    sent: dict[str, int] = field(default_factory=dict)  # topic -> messages
    damaged: dict[str, int] = field(default_factory=dict)

    @property
    def total(self) -> int:
        return sum(self.sent.values())


class Player:
    """Publishes what a recording holds, at the pace at which it was recorded."""

    def __init__(self, ros: "Ros", found: Matches, keep_stamps: bool) -> None:
        """Make the publishers and wait for the readers.

        Raises:
            TmsError: NO_READER, tms:sp does not subscribe to a topic; TWO_SOURCES, another node publishes on one.
        """
        self.reported = Played(dict.fromkeys((track.topic for track in found.played), 0))
        self._ros, self._keep = ros, keep_stamps
        self._stamps = {t.topic: Stamps(given, message_class(given.type)) for t, given in found.played.items()}
        self._publishers = {t.topic: ros.publisher(message_class(t.type), t.topic, DEPTH) for t in found.played}
        deadline = monotonic() + READER_LIMIT
        while deaf := [topic for topic, one in self._publishers.items() if not one.get_subscription_count()]:
            if monotonic() > deadline:
                raise TmsError(NobodyListens(tuple(deaf)), "NO_READER")
            sleep(0.02)
        others = [topic for topic in self._publishers if ros.node.count_publishers(topic) > 1]
        if others:
            raise TmsError(TwoSources(tuple(others)))

    def play(
        self, recording: Recording, tracks: list[Track], span: tuple[int, int], pace: Pace, tick: Callable[[int], None]
    ) -> None:
        """Play it once; `tick` is called with the reached moment (ns of the recording).

        Raises:
            TmsError: BAD_BAG, BAD_STAMP.
        """
        for number, (track, moment, data) in enumerate(recording.messages(tracks, *span)):
            if number % 100 == 0:
                tick(moment)
            while (seconds := pace.wait(moment)) > 0.0:
                sleep(min(seconds, SLICE))
                tick(pace.moment())
            self._publish(track.topic, moment, data, pace)
        tick(span[1])

    def _publish(self, topic: str, moment: int, data: bytes, pace: Pace) -> None:
        stamps = self._stamps[topic]
        try:
            message: Any = stamps.check(data)
        except RuntimeError:
            self.reported.damaged[topic] = self.reported.damaged.get(topic, 0) + 1
            return
        stamp = None if self._keep else stamps.read(message)
        if stamp is not None:
            data = stamps.replaced(data, message, pace.stamp(topic, stamp, moment))
        self._publishers[topic].publish(data)
        self.reported.sent[topic] += 1

    def finish(self) -> None:
        """Wait until the readers have received all messages."""
        for publisher in self._publishers.values():
            self._ros.delivered(publisher, LAST_LIMIT)
