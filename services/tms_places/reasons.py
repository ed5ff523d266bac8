"""Why a machine has to wait for a shared place, why one is not freed, and who waits for whom in a circle."""

from tms_reason.quantities import Seconds
from tms_reason.reason import Reason
from tms_reason.remedies import INSPECT, PROCESSES, Remedy

SHOW_PLACES = Remedy("places", "tms places", "See who holds which place, and who waits for it")
REVOKE = Remedy("revoke", "tms places revoke NAME", "Take a place from its holder, or cancel one of the runs")


# fmt: off
# requests
class NoPlace(Reason, text="there is no shared place '{place}' (there: {places})", action=SHOW_PLACES):
    place: str; places: tuple[str, ...]
class PlaceFree(Reason, text="nobody holds {place}", action=SHOW_PLACES): place: str
class PlacesUnread(Reason, text="who holds which place was not read from the database yet", action=PROCESSES): pass

# goals of a gateway
class PlacesNeeded(Reason, text="{machine} must hold {places} first: a node HoldPlace does that, and so do subtasks",
    action=SHOW_PLACES): machine: str; places: tuple[str, ...]
class LeaseOver(Reason, text="{machine} may not go on in {place}: its lease is over, and tms:db has not renewed it",
    action=PROCESSES): machine: str; place: str
class OnlyOut(Reason, text="{machine} has lost {place}: it may only drive out of it", action=SHOW_PLACES):
    machine: str; place: str

# waiting
class WaitsForPlace(Reason, text="{machine} waits for {place}, which {holder} has held since {since}",
    action=SHOW_PLACES): machine: str; place: str; holder: str; since: str
class WaitsItsTurn(Reason, text="{machine} waits for {place}: {ahead} came first", action=SHOW_PLACES):
    machine: str; place: str; ahead: str
class WaitsForLease(Reason, text="{machine} has {place}: its gateway is being told", action=SHOW_PLACES):
    machine: str; place: str
class WaitsForKeeper(Reason, text="{machine} waits for an answer about {place} by tms:db", action=PROCESSES):
    machine: str; place: str

# why a place is not granted, or not freed
class KeeperStarts(Reason,
    text="after its start the keeper waits until all gateways were heard, or their leases ran out"): pass
class InsideStill(Reason, text="{machine} is still inside"): machine: str
class PlaceUncertain(Reason, text="it is not certain where {machine} is", action=INSPECT): machine: str
class HolderSilent(Reason, text="the gateway of {machine} has said nothing for {seconds}", action=PROCESSES):
    machine: str; seconds: Seconds
class HolderUnheard(Reason, text="the gateway of {machine} has said nothing yet", action=PROCESSES): machine: str
class RevokedBy(Reason, text="{person} took it from {machine}: {why}"): person: str; machine: str; why: Reason
class NotGivenBack(Reason, text="{machine} has not given it back yet"): machine: str

# alarms
class WaitingCircle(Reason, text="machines wait for each other and none can go on: {circle}", action=REVOKE):
    circle: tuple[str, ...]
class TwoInPlace(Reason, text="{machine} is in {place}, which {holder} holds", action=INSPECT):
    machine: str; place: str; holder: str

# before a run
class HoldsAndTakes(Reason, text="{machine} holds {held} and takes {taken}"): machine: str; held: str; taken: str
class MayWaitInCircle(Reason, text="these may come to wait for each other, which only a person could end: {circle}",
    action=SHOW_PLACES): circle: tuple[Reason, ...]
# fmt: on
