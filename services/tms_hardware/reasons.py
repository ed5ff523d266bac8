"""What a machine's hardware forbids, and what is not known of it."""

from tms_reason.quantities import Seconds
from tms_reason.reason import Reason
from tms_reason.remedies import INSPECT, Remedy

RELEASE = Remedy("look", "", "Look at the machine, release its stop, and re-arm it")
UNLOCK = Remedy("look", "", "Look at the machine, and unlock its lever")
TO_REMOTE = Remedy("look", "", "Set the switch of the machine to remote")
START_ENGINE = Remedy("look", "", "Start the engine")


# fmt: off
class EmergencyStopPressed(Reason, text="{machine}: its own emergency stop is pressed", action=RELEASE): machine: str
class LeverLocked(Reason, text="{machine}: its lock lever is locked", action=UNLOCK): machine: str
class SwitchedToManual(Reason, text="{machine}: its switch stands on manual", action=TO_REMOTE): machine: str
class EngineOff(Reason, text="{machine}: its engine does not run", action=START_ENGINE): machine: str
class SignalUnheard(Reason, text="{machine} has not told yet: {signal}", action=INSPECT): machine: str; signal: str
class SignalSilent(Reason, text="{machine} has not told for {age}: {signal}", action=INSPECT):
    machine: str; signal: str; age: Seconds
class SignalUnreadable(Reason, text="{machine} tells what cannot be read: {signal}", action=INSPECT):
    machine: str; signal: str
class CounterFrozen(Reason, text="{machine}: its alive counter has stood still for {age}", action=INSPECT):
    machine: str; age: Seconds
# fmt: on
