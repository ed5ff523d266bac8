"""Why a process cannot begin or work, and what a PC's disk does not take."""

from tms_reason.quantities import Seconds
from tms_reason.reason import Reason
from tms_reason.remedies import LOGS, OTHER_FOLDER, RESTART, RETRY, STATUS, Remedy

OTHER_PORT = Remedy("edit_config", "", "Stop the other program, or change ports.metrics in the site file")


# fmt: off
# processes
class ProcessStarting(Reason, text="it is starting", action=RETRY): pass
class PortSilent(Reason, text="{process} does not answer on its health port", action=LOGS): process: str
class PortTaken(Reason, text="port {port} on {address} is taken ({problem})", action=OTHER_PORT):
    port: int; address: str; problem: str
class ParentGone(Reason, text="supervisord ended while this process started"): pass
class PcBusy(Reason, text="its PC was too busy for {seconds}"): seconds: Seconds
class LongCallback(Reason, text="a callback took {seconds}, or the process was frozen"): seconds: Seconds
class Hangs(Reason, text="{process} has not run for {seconds}", action=RESTART): process: str; seconds: Seconds
class NotConnected(Reason, text="{reader} does not receive what {writer} publishes", details="{topic}: {problem}"):
    topic: str; reader: str; writer: str; problem: str

# the disk of this PC
class NotStored(Reason, text="{end} (not stored yet: the disk of the scheduler's PC is slow or full)", action=STATUS):
    end: Reason
class OthersFile(Reason, text="belongs to another user, and others may read it", action=OTHER_FOLDER,
    details="or give the folder to this user: `chown -R {user}`"): user: int
