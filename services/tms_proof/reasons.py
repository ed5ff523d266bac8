"""What a machine tells of itself, and why that is no proof."""

from tms_reason.quantities import Radians, Seconds
from tms_reason.reason import Reason
from tms_reason.remedies import EDIT_CONFIG, INSPECT


# fmt: off
class JointStates(Reason, text="joint states"): pass
class Odometry(Reason, text="odometry"): pass
class Pose(Reason, text="pose"): pass
class Imu(Reason, text="IMU"): pass
class Unheard(Reason, text="no {source} from the machine yet", action=INSPECT, details="{topic}"):
    source: Reason; topic: str
class UnheardOf(Reason, text="no {source} of {part} from the machine yet", action=INSPECT, details="{topic}"):
    source: Reason; part: str; topic: str
class Old(Reason, text="{source} {age} old", details="{topic}"): source: Reason; age: Seconds; topic: str
class OldOf(Reason, text="{source} of {part} {age} old", details="{topic}"):
    source: Reason; part: str; age: Seconds; topic: str
class NoSource(Reason, text="the border declares no source that tells of its motion", action=EDIT_CONFIG): pass
class ManyPublishers(Reason, text="{source} come from {count} publishers", details="{nodes}"):
    source: Reason; count: int; nodes: tuple[str, ...]
class TwoPublishers(Reason, text="{source} come from two publishers: their numbers go back and forth"): source: Reason
class StampRepeated(Reason, text="{source} repeat a stamp that does not advance"): source: Reason
class Implausible(Reason, text="{source} are implausible: {part}: {why}"): source: Reason; part: str; why: Reason
class PositionsMove(Reason, text="positions move, velocities say that it stands"): pass
class VelocitiesMove(Reason, text="velocities say that it moves, positions stand"): pass
class NewClock(Reason, text="{source}: {why}"): source: Reason; why: Reason
class ClockAhead(Reason, text="their stamps are {seconds} ahead of {clock}"): seconds: Seconds; clock: Reason
class ClockBack(Reason, text="{clock} jumped back by {seconds}"): clock: Reason; seconds: Seconds
class UtcClock(Reason, text="the clock of the PC that stamps them (UTC)"): pass
class SimulatorClock(Reason, text="the simulator's clock"): pass
class Beyond(Reason, text="{source}: {joint} is told at {angle}, where it cannot be (limit {limit})"):
    source: Reason; joint: str; angle: Radians; limit: Radians
class Moving(Reason, text="still moving"): pass
class NotLongEnough(Reason, text="not seen to stand for long enough"): pass
class Stalled(Reason, text="{joint} stands at {angle}, it should have passed {due}"):
    joint: str; angle: Radians; due: Radians
class OffPath(Reason, text="{joint} is at {angle}, its way has been between {low} and {high}"):
    joint: str; angle: Radians; low: Radians; high: Radians
class Frozen(Reason, text="{source} are the same to the last bit for {seconds} while the machine should move"):
    source: Reason; seconds: Seconds
# fmt: on
