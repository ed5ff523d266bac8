"""Why a motion controller cannot move its machine."""

from tms_reason.quantities import Seconds
from tms_reason.reason import Reason
from tms_reason.remedies import EDIT_CONFIG, INSPECT, PROCESSES


# fmt: off
# what it lacks
class JointsNotHeard(Reason, text="the machine does not tell where its joints are", action=INSPECT, details="{topic}"):
    topic: str
class JointsSilent(Reason, text="the machine has not told where its joints are for {seconds}", action=INSPECT,
    details="{topic}"): seconds: Seconds; topic: str
class JointMissing(Reason, text="the machine does not tell where {joint} is", action=INSPECT, details="{topic}"):
    joint: str; topic: str
class NoCommandTopic(Reason, text="the machine file has no topic that moves {joint}", action=EDIT_CONFIG): joint: str
class StillMoves(Reason, text="the machine does not stand yet"): pass
class GatewayAbsent(Reason, text="the gateway does not stand behind the machine", action=PROCESSES): pass
class NoAngle(Reason, text="the angle for {joint} is not a number"): joint: str
class JointLimit(Reason, text="{joint}: {why}"): joint: str; why: Reason
class StopPressed(Reason, text="the emergency stop of the machine is on"): pass
class PosesUnheard(Reason, text="the machine does not tell where it is", action=INSPECT, details="{topic}"): topic: str
class PosesSilent(Reason, text="the machine has not told where it is for {seconds}", action=INSPECT,
    details="{topic}"): seconds: Seconds; topic: str
class NoPoses(Reason, text="the goal has no pose"): pass
class StrangeFrame(Reason, text="pose {number} is told in the frame '{frame}', not in 'map'"): number: int; frame: str
class PoseUnfit(Reason, text="pose {number} holds no orientation, or a value that is not a number"): number: int
class AreaUnfit(Reason, text="area '{area}' needs x and y of {least} to {most} corners in turn, as numbers"):
    area: str; least: int; most: int
class AreasUnread(Reason, text="the blocked areas and roads are as they were read last: {why}"): why: Reason
class RoadUnfit(Reason, text="road '{road}' needs names of records in turn"): road: str
class RoadShort(Reason, text="road '{road}' has only one place"): road: str
class SectionUnfit(Reason, text="record '{section}' needs x and y, as numbers or as lists of one length"): section: str
class ManyPlaces(Reason, text="all roads together have {count} places every five metres, more than {most}"):
    count: int; most: int

# what a way keeps clear of
class AreaBorder(Reason, text="the border of the areas where it may be"): pass

# the end of a goal
class GatewayGone(Reason, text="the gateway was lost while the machine moved"): pass
class ControllerStood(Reason, text="the motion controller did not run for {seconds}", action=PROCESSES):
    seconds: Seconds
class ClockSetBack(Reason, text="the clock of the machine was set back: its simulator was started again"): pass
class EmergencyStopped(Reason, text="the emergency stop was pressed"): pass
class Stopped(Reason, text="stopped on request"): pass
# fmt: on
