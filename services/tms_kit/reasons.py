"""Why earth cannot be moved, and how far it has been."""

from tms_reason.quantities import CubicMetres
from tms_reason.reason import Reason
from tms_reason.remedies import PROCESSES, RECORDS, Remedy

MOVE_ON = Remedy("move", "", "Move the machine, or change the area or the floor of the record")


# fmt: off
class NothingToDig(Reason, text="nothing is left to dig in reach of {machine}: {record} tells where it may",
    action=MOVE_ON): machine: str; record: str
class NoDigPlanned(Reason, text="the {count} best places in reach of {machine} cannot be dug: {why}",
    action=MOVE_ON): count: int; machine: str; why: Reason
class PlaceNotTold(Reason, text="{machine} does not tell where it is", action=PROCESSES): machine: str
class LoadNotTold(Reason, text="nobody tells what {machine} carries: it needs tms:ground", action=PROCESSES):
    machine: str
class NoPart(Reason, text="{machine} has no {part}:", action=RECORDS): machine: str; part: str

# progress
class WaitsForTruck(Reason, text="waits for a truck in reach that is not full: {trucks}"): trucks: tuple[str, ...]
class WaitsForLoad(Reason, text="is being loaded: {loose} of {full}"): loose: CubicMetres; full: CubicMetres
class Moved(Reason, text="{moved} of {volume} are moved, in {count} buckets"):
    moved: CubicMetres; volume: CubicMetres; count: int
# fmt: on
