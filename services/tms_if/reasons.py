"""Reasons why the ROS-TCP endpoint cannot be served."""

from tms_reason.quantities import Seconds
from tms_reason.reason import Reason
from tms_reason.remedies import PROCESSES, Remedy

OTHER_INTERFACE_PORT = Remedy("edit_config", "", "Stop the other program, or change services.if in the site file")


# fmt: off
class InterfacePortTaken(Reason, text="{address} cannot be listened on ({problem})", action=OTHER_INTERFACE_PORT):
    address: str; problem: str
class NoTrial(Reason, text="this installation has no stand-in of OperaSim-PhysX: start it from a clone",
    details="{folder}"): folder: str
class ExecutorBusy(Reason, text="the process is too busy: it did not come to this within {waited}",
    action=PROCESSES): waited: Seconds
