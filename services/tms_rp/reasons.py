"""Why a planner makes no trajectory, how far a motion is, and why it ended."""

from tms_reason.quantities import Metres, Moments, Number, Percent, Radians, Seconds
from tms_reason.reason import Reason
from tms_reason.remedies import INSPECT, PROCESSES, RECORDS, Remedy

ONE_TARGET = Remedy("goal", "", "Give exactly one of the three")
NEARER = Remedy("goal", "", "Choose a nearer point")
FURTHER = Remedy("goal", "", "Choose a point further out")
OTHER_POINT = Remedy("goal", "", "Choose another point or another bucket angle")
INSIDE = Remedy("goal", "", "Choose a target inside the limits")
OTHER_TARGET = Remedy("goal", "", "Choose another target, or move away first")
PLAN_AGAIN = Remedy("goal", "", "Plan anew from where the machine is")
ADD_JOINTS = Remedy("edit_config", "", "Add them under joints:, geometry: and shapes: of the machine file")


# fmt: off
# progress
class Planning(Reason, text="the motion is planned"): pass
class Planned(Reason, text="planned: it takes {duration}"): duration: Seconds
class MoveOf(Reason, text="move {number} of {count}, {percent}"): number: int; count: int; percent: Percent
class Adapted(Reason, text="{progress} ({notes})"): progress: Reason; notes: tuple[Reason, ...]
class OtherAngle(Reason, text="bucket angle {chosen} instead of {wanted}"): chosen: Radians; wanted: Radians
class DragCut(Reason, text="it drags {drag} instead of {wanted}: the arm gets no further"):
    drag: Metres; wanted: Metres
class ClearanceCut(Reason, text="{joint} moves clear to its limit {limit} only"): joint: str; limit: Radians
class Around(Reason, text="{way}, as {why}"): way: Reason; why: Reason
class LiftSwingLower(Reason, text="it lifts, swings and lowers"): pass
class FoldSwingUnfold(Reason, text="it lifts, curls in, swings and unfolds"): pass
class OtherWayRound(Reason, text="{way}, the other way round"): way: Reason
class Searched(Reason, text="it takes a way that was searched"): pass
class SlowlyOut(Reason, text="it moves slowly, as {bodies} seem to overlap at the start"): bodies: Reason
class PlannedAnew(Reason, text="{why}; the rest is planned anew after {pause}"): why: Reason; pause: Seconds
class Succeeded(Reason, text="done"): pass
class MotionCancelled(Reason, text="cancelled"): pass

# what a goal asks
class OneTarget(Reason, text="the goal gives {count} targets: joint angles, poses or bucket positions",
    action=ONE_TARGET, details="trajectory, pose_sequence, position_with_angle_sequence"): count: int
class AnglesUnfit(Reason, text="{angles} angles for {joints} joints"): joints: int; angles: int
class NamedTwice(Reason, text="a joint is named twice: {joints}"): joints: tuple[str, ...]
class FieldNotFinite(Reason, text="a value is not a number", details="{field}"): field: str
class NoOrientation(Reason, text="the orientation is empty: its quaternion has the length {length}, not 1"):
    length: Number
class OutOfPlane(Reason, text="the orientation points {angle} out of the arm's plane; turned to {yaw} it lies in it"):
    angle: Radians; yaw: Radians

# goals of the C++ system's version 6
class UnknownCommand(Reason, text="there is no command {number}"): number: int
class NothingToExecute(Reason, text="the goal has no plan to execute"): pass
class SettingNotHonoured(Reason, text="the planner cannot be set so: {name} {value}"): name: str; value: str
class PlannerAway(Reason, text="the C++ system's planner of {machine} does not answer", details="{name}",
    action=INSPECT): machine: str; name: str
class PlannerRefuses(Reason, text="the C++ system's planner of {machine} makes no plan: {why}",
    details="error {number}"): machine: str; why: Reason; number: int
class PlanMisses(Reason, text="its plan ends with {joint} at {end}, not at {angle}"):
    joint: str; end: Radians; angle: Radians

# what the arm can reach
class Point(Reason, text="point ({x}, {y}, {z}) with bucket angle {theta_w}"):
    x: Metres; y: Metres; z: Metres; theta_w: Radians
class TooFar(Reason, text="{point} is {missing} too far", action=NEARER, code="OUT_OF_REACH"):
    point: Reason; missing: Metres
class TooNear(Reason, text="{point} is {missing} too near", action=FURTHER): point: Reason; missing: Metres
class TooNearAxis(Reason, text="point ({x}, {y}) is {missing} too near the swing axis", action=FURTHER):
    x: Metres; y: Metres; missing: Metres
class JointBroken(Reason, text="{joint} {why}"): joint: str; why: Reason
class OutOfRange(Reason, text="{broken}", action=INSIDE): broken: tuple[Reason, ...]
class PointOutOfRange(Reason, text="{point} needs {broken}", action=OTHER_POINT):
    point: Reason; broken: tuple[Reason, ...]
class DigUnfit(Reason, text="depth {depth} must be above 0, drag {drag} and lift {lift} not below",
    action=RECORDS): depth: Metres; drag: Metres; lift: Metres
class NoAngleDigs(Reason, text="no bucket angle from 0 to pi digs there: {why}"): why: Reason
class WouldSpill(Reason, text="soil would fall out on the way to {point}: the bucket is {tilt} from level there",
    action=NEARER): point: Reason; tilt: Radians
class Collision(Reason, text="{first} would touch {second} after {seconds}, {depth} deep at ({x}, {y}, {z})",
    action=OTHER_TARGET):
    first: Reason; second: Reason; seconds: Seconds; depth: Metres; x: Metres; y: Metres; z: Metres
class NoWayRound(Reason, text="{why}; no way round was found", action=OTHER_TARGET): why: Reason
class Part(Reason, text="{link}"): link: str
class Ground(Reason, text="the ground"): pass
class PartOf(Reason, text="{link} of {machine}"): link: str; machine: str
class NoTrajectory(Reason, text="there is no trajectory inside the limits", details="{problem}"): problem: str
class LimitsLeft(Reason, text="{joint} would leave its limits after {seconds}"): joint: str; seconds: Moments

class Between(Reason, text="{first} and {second}"): first: Reason; second: Reason
class NoSuchAction(Reason, text="the planner has no action '{action}' (there are {actions})"):
    action: str; actions: tuple[str, ...]
class GoalUnreadable(Reason, text="this is no goal of {action}"): action: str

# stored plans
class PlanWrong(Reason, text="plan {number}: {why}", action=PLAN_AGAIN): number: int; why: Reason
class PlanLacks(Reason, text="its joints are not those of the arm", details="missing: {joints}"):
    joints: tuple[str, ...]
class PlanBroken(Reason, text="it is no motion from rest to rest"): pass
class PlanElsewhere(Reason, text="it begins with {joint} at {begin}, but the arm is at {angle} then"):
    joint: str; begin: Radians; angle: Radians
class GoesOn(Reason, text="it goes on in plan {number}, {seconds} after its begin, where the arm stands"):
    number: int; seconds: Seconds
class PlanTooFast(Reason, text="{joint} would be faster than its limits after {seconds}"): joint: str; seconds: Moments

# the machine
class JointsUnheard(Reason, text="the joints of {machine} were not received yet: is the machine on?", action=INSPECT,
    details="{topic} with {joints}"): machine: str; topic: str; joints: tuple[str, ...]
class JointsOld(Reason, text="the joints of {machine} were received {age} ago: is the machine on?", action=INSPECT,
    details="{topic}"): machine: str; age: Seconds; topic: str
class GatewayAway(Reason, text="{process} is not there", details="{name}", action=PROCESSES): process: str; name: str
class MotionLate(Reason, text="{machine} was not done {seconds} after the end of its trajectory"):
    machine: str; seconds: Seconds
class MotionFailed(Reason, text="{why}", details="{name} {outcome}"): why: Reason; name: str; outcome: str

class Told(Reason, text="{record}"): record: str
class NoShape(Reason, text="it has no dimensions, and there is no machine '{named}'"): named: str
class SizesUnfit(Reason, text="it has {told} dimensions, not {needed}"): needed: int; told: int
class MeshEmpty(Reason, text="its surface has no corners or no triangles"): pass
class MeshNotFinite(Reason, text="a value of its surface is not a number"): pass
class MeshCorners(Reason, text="its triangles are not three numbers each of its {corners} corners"): corners: int
class MeshAsFile(Reason,
    text="its surface is stored as a file (DAE), which is not read: it needs vertices and triangles"): pass
class MeshLarge(Reason, text="its surface has {triangles} triangles: {limit} at most"): triangles: int; limit: int
class MeshSimplified(Reason,
    text="the surface of {record} is planned with as {kept} of {triangles} triangles, up to {off} off"):
    record: str; triangles: int; kept: int; off: Metres
class NamesUnfit(Reason, text="{field} is no list of names"): field: str
class NoSuchObstacle(Reason, text="it names the record '{named}', which is not there"): named: str
class PaddingUnfit(Reason, text="its padding of '{link}' is none of a link of the machine, from 0 to {limit}"):
    link: str; limit: Metres
class SceneRecordOld(Reason, text="record {record} is {age} old: nobody knows what stands there now", action=RECORDS):
    record: str; age: Seconds
class SceneUnread(Reason, text="the scene records are as they were read last: {why}"): why: Reason
class GroundUnread(Reason, text="the ground is as it was told last: {why}"): why: Reason
class PlaceUnknown(Reason, text="it is not known where {machine} stands: the other machines are left out",
    details="nothing on /tf"): machine: str

# configuration
class NoArm(Reason, text="a backhoe needs {joints}", action=ADD_JOINTS): joints: tuple[str, ...]
