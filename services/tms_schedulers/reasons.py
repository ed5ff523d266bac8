"""Why a scheduler does not get a machine, and which one takes a task."""

from tms_reason.quantities import Seconds
from tms_reason.reason import Reason
from tms_reason.remedies import LOGS, PROCESSES, RETRY, RUNS


# fmt: off
class MachineLeased(Reason, text="{machine} is in run {run} of {scheduler}", action=RUNS):
    machine: str; run: str; scheduler: str
class RunOutdated(Reason, text="{machine} has had a newer run, {run}: start the task again", action=RETRY):
    machine: str; run: str
class LeasesUnread(Reason, text="which run has which machine was not read from the database yet", action=PROCESSES):
    pass
class LeasesUnreadable(Reason, text="the leases of machines in the database cannot be read", action=PROCESSES): pass
class RunNotBegun(Reason, text="the run did not begin within {limit}", action=LOGS): limit: Seconds; process: str
class OtherScheduler(Reason, text="{scheduler} runs tasks of {machines}: send it there", code="OTHER_SCHEDULER"):
    scheduler: str; machines: tuple[str, ...]
