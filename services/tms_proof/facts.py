"""What the decisions must know of a machine: plain figures, from its model and its border."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

Stamps = Literal["utc", "since_start", "none"]
PERIODS = 3  # periods in which a stamp may stand still, or no message come
SHORTEST = 0.2  # s; the gateway takes messages 20 times a second, and PCs are busy


@dataclass(frozen=True)
class JointFacts:
    """One joint; without `low` and `high` it turns for ever."""

    velocity: float  # rad/s, at most
    low: float | None = None  # rad
    high: float | None = None  # rad


@dataclass(frozen=True)
class ResponseFacts:
    """The answer of a joint, or of the tracks, to a command."""

    dead_time: float  # s
    lag: float  # s, time constant
    brakes: float  # s from top speed to rest


@dataclass(frozen=True)
class StillFacts:
    """When the machine counts as standing."""

    velocity: float  # rad/s, every joint below it ...
    linear: float  # m/s, ... the base below this ...
    angular: float  # rad/s, ... and this ...
    seconds: float  # s, ... for this long


@dataclass(frozen=True)
class SourceFacts:
    """One topic that tells of the machine's motion."""

    period: float  # s between messages
    stamps: Stamps
    frozen_after: float  # s with equal values while a goal should change them
    topic: str  # its full name
    resolution: float = 0.0  # rad or m by which positions jitter

    @property
    def longest(self) -> float:
        """Seconds without a new stamp; then it is no proof any more."""
        return max(PERIODS * self.period, SHORTEST)


@dataclass(frozen=True)
class MachineFacts:
    """One machine. Its figures are in the machine's own time, of which `speed` seconds pass in one of ours."""

    name: str
    joints: Mapping[str, JointFacts]
    joint_response: Mapping[str, ResponseFacts]  # without passive joints, which no command moves
    still: StillFacts
    sources: Mapping[str, SourceFacts]
    drive_response: ResponseFacts | None = None  # of the tracks
    drive_velocity: float = float("inf")  # m/s, at most
    turn_velocity: float = float("inf")  # rad/s, at most
    stops_at_once: bool = False  # its `emg_stop` acts without the dead time
    jumps: float = 0.0  # s after a re-arm in which the release of its `emg_stop` may move it a little
    speed: float = 1.0  # of a stand-in

    @property
    def responses(self) -> list[ResponseFacts]:
        """Of all joints that commands move, and of the tracks."""
        return [*self.joint_response.values(), *([self.drive_response] if self.drive_response is not None else [])]
