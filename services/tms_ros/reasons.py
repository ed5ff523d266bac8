"""What goes wrong between processes. `process` is as `tms ps` lists it, `name` as ROS does."""

from tms_reason.quantities import Seconds
from tms_reason.reason import Reason
from tms_reason.remedies import LOGS, PROCESSES


# fmt: off
# a goal ended because a process did: its run may send it again
class BeingStopped(Reason, text="{process} is being stopped"): process: str
class StoppedMeanwhile(Reason, text="{process} was stopped during its goal"): process: str
class LostMeanwhile(Reason, text="{process} was lost during its goal", details="{name}"): process: str; name: str

# calls
class NoServer(Reason, text="{process} is not there (waited {waited})", details="{name}",
    action=PROCESSES): process: str; name: str; waited: Seconds
class NoAnswer(Reason, text="{process} did not answer within {waited}", details="{name}",
    action=PROCESSES): process: str; name: str; waited: Seconds
class BadServiceName(Reason, text="there can be no service '{name}'", details="{problem}"): name: str; problem: str
class Internal(Reason, text="{process} has made a mistake: this is a bug", action=LOGS): process: str
