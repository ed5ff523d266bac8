"""What is wrong with areas, and why a machine may not go on because of them."""

from tms_reason.quantities import Metres, MetresPerSecond, Seconds, SquareMetres
from tms_reason.reason import Reason
from tms_reason.remedies import EDIT_CONFIG, ESCAPE, INSPECT, RESTART, Remedy

DRAW_AGAIN = Remedy("draw", "", "Draw the area again, and export the file anew")
CHECK_AGAIN = Remedy("check_areas", "", "Check the areas again")
LOOK_AROUND = Remedy("look", "", "Look who is in the area, and re-arm once it is free")
SEE_TRACKER = Remedy("look", "", "Look at the tracker and at its PC")
DRIVE_OUT = Remedy("take", "tms take {machine}", "Drive the machine by hand to where it may be")


# fmt: off
# files
class AreaFile(Reason, text="{file}: {why}"): file: str; why: Reason
class OfArea(Reason, text="area {area}: {why}"): area: str; why: Reason
class AreaFileLarge(Reason, text="is larger than {limit} bytes", action=DRAW_AGAIN): limit: int
class NoJson(Reason, text="is no JSON, line {line}, column {column}", action=DRAW_AGAIN): line: int; column: int
class NoOriginForAreas(Reason, text="its corners are in degrees, and the site file tells no ground.origin",
    action=EDIT_CONFIG): pass
class OtherCoordinates(Reason, text="its coordinates are '{crs}', not longitude and latitude (WGS84) or those of map",
    action=DRAW_AGAIN): crs: str

# one area
class RingOpen(Reason, text="its last corner is not its first one", action=DRAW_AGAIN): pass
class HasHole(Reason, text="it has a hole: make the hole a blocked area", action=DRAW_AGAIN): pass
class FewCorners(Reason, text="it has {corners} different corners, 3 are needed", action=DRAW_AGAIN): corners: int
class ManyCorners(Reason, text="it has {corners} corners, {limit} are allowed", action=DRAW_AGAIN):
    corners: int; limit: int
class CrossesItself(Reason, text="its border crosses or touches itself near ({x}, {y})", action=DRAW_AGAIN):
    x: Metres; y: Metres
class TooSmall(Reason, text="it has {size} only", action=DRAW_AGAIN): size: SquareMetres
class TooFar(Reason, text="its corner ({x}, {y}) is further than {limit} from the origin of the map",
    action=DRAW_AGAIN): x: Metres; y: Metres; limit: Metres
class NeedsSpeed(Reason, text="a speed limit needs maximum_speed, another area has none", action=EDIT_CONFIG): pass
class NeedsNoLoss(Reason, text="only a release area has on_loss", action=EDIT_CONFIG): pass

# a set
class ManyAreas(Reason, text="there are {count} areas, {limit} are allowed", action=EDIT_CONFIG): count: int; limit: int
class AreaTwice(Reason, text="two areas are called {area}", action=EDIT_CONFIG): area: str
class NoUnmanned(Reason, text="no area is unmanned: no machine could move anywhere", action=EDIT_CONFIG): pass
class NothingUsable(Reason, text="other areas cover every unmanned one: no machine could move anywhere",
    action=EDIT_CONFIG): pass
class AreasNotEnabledBy(Reason, text="{machine} refuses the areas: {why}"): machine: str; why: Reason
class AreasNotReached(Reason, text="the gateway of {machine} tells nothing of areas: {why}", action=RESTART):
    machine: str; why: Reason; process: str
class AreasNotShown(Reason, text="these are other areas than those that were checked", action=CHECK_AGAIN): pass

# people and vehicles
class TrackerTypeWrong(Reason, text="a tracker of the kind {kind} sends one of {types}", action=EDIT_CONFIG):
    kind: str; types: tuple[str, ...]
class TopicOrRecord(Reason, text="a tracker tells by a topic or by a record: one of the two", action=EDIT_CONFIG): pass
class NoTracker(Reason, text="sensing.yaml has no tracker {name}; it has {known}", action=EDIT_CONFIG):
    name: str; known: tuple[str, ...]
class GateNeedsArea(Reason, text="a gate names the unmanned areas that it leads to", action=EDIT_CONFIG): pass
class TrackersNeedAreas(Reason, text="trackers take areas of the site, of which there are none: {trackers}",
    action=EDIT_CONFIG): trackers: tuple[str, ...]
class TrackerOfNoArea(Reason, text="tracker {tracker}: there is no unmanned area {area}, but {known}",
    action=EDIT_CONFIG): tracker: str; area: str; known: tuple[str, ...]
class APerson(Reason, text="a person"): pass
class AVehicle(Reason, text="a vehicle"): pass
class IntruderInside(Reason, text="{machine}: {who} is in the unmanned area {area} near ({x}, {y}), as {tracker} says",
    action=LOOK_AROUND): machine: str; who: Reason; area: str; tracker: str; x: Metres; y: Metres
class IntruderNear(Reason, text="{machine}: {who} is in the restricted area {area} near ({x}, {y}), as {tracker} says",
    action=LOOK_AROUND): machine: str; who: Reason; area: str; tracker: str; x: Metres; y: Metres
class GateOpened(Reason, text="{machine}: {gate} was opened, somebody may be in {areas}", action=LOOK_AROUND):
    machine: str; gate: str; areas: tuple[str, ...]
class TrackerSilent(Reason, text="{tracker} has told nothing for {age}: somebody may be inside", action=SEE_TRACKER):
    tracker: str; age: Seconds
class TrackerUnheard(Reason, text="{tracker} has not told yet whether somebody is inside", action=SEE_TRACKER):
    tracker: str
class TrackerUnreadable(Reason, text="{tracker} tells what cannot be used ({why}): somebody may be inside",
    action=SEE_TRACKER): tracker: str; why: Reason
class NotInMapFrame(Reason, text="its places are in the frame '{frame}', not in map"): frame: str
class PlacesUneven(Reason, text="its record needs x and y, numbers or arrays of one length"): pass
class NoSwitch(Reason, text="its record needs `opened`, true or false"): pass
class PlaceNoNumber(Reason, text="a place is not a number"): pass
class ManyIntruders(Reason, text="it tells {count} places, {limit} are allowed"): count: int; limit: int
class TrackerClockAhead(Reason, text="its stamp is {ahead} ahead of the clock of this PC"): ahead: Seconds

# a machine
class LeavesArea(Reason, text="{machine} must not leave the unmanned area {area}: its border near ({x}, {y}) is"
    " {gap} away, to stop takes {needed}", action=ESCAPE):
    machine: str; area: str; gap: Metres; needed: Metres; x: Metres; y: Metres
class EntersArea(Reason, text="{machine} must not enter the area {area}: its border near ({x}, {y}) is {gap} away,"
    " to stop takes {needed}", action=ESCAPE):
    machine: str; area: str; gap: Metres; needed: Metres; x: Metres; y: Metres
class TooFastFor(Reason, text="{machine} would be in the area {area} at {speed}, {limit} are allowed there",
    action=DRIVE_OUT): machine: str; area: str; speed: MetresPerSecond; limit: MetresPerSecond
class NoWay(Reason, text="no way inside the unmanned areas leads {machine} to ({x}, {y})"):
    machine: str; x: Metres; y: Metres
class ComesFurtherOut(Reason, text="{machine} may only come back in, but would be {depth} out of where it may be"
    " instead of {before}, or further in another area", action=ESCAPE): machine: str; depth: Metres; before: Metres
class NotFurtherIn(Reason, text="{machine} may only come back in: it is {now} out of where it may be, and would be"
    " {then}"): machine: str; now: Metres; then: Metres
class EscapesTooFast(Reason, text="{machine} comes back in at {speed}, {limit} are allowed", action=ESCAPE):
    machine: str; speed: MetresPerSecond; limit: MetresPerSecond
class TracksNotSlow(Reason, text="what drives {machine} cannot be told to go slowly", action=DRIVE_OUT): machine: str
class PoseUnknown(Reason, text="its place in the map is not told", action=INSPECT): pass
class PoseOld(Reason, text="its place in the map is {age} old", action=INSPECT): age: Seconds
class PoseJumped(Reason, text="its place in the map has jumped", action=INSPECT): pass
class PoseStuck(Reason, text="its place in the map does not change while its tracks move", action=INSPECT): pass
class PoseVague(Reason, text="its localisation tells a deviation of {deviation}, {limit} are allowed", action=INSPECT):
    deviation: Metres; limit: Metres
class FixLost(Reason, text="its GNSS has no RTK fix", action=INSPECT): pass
class FixOld(Reason, text="its GNSS tells nothing of its fix", action=INSPECT): pass
class PoseSettles(Reason, text="{why}: it is believed again after {left} without that"): why: Reason; left: Seconds
# fmt: on
