"""What a run wants to be done, in the order of the list."""

from tms_decision.data import Effect
from tms_reason.reason import Reason


# fmt: off
class Hold(Effect): pass  # the permits of its machines; then `Held`
class Drop(Effect): pass
class Enter(Effect): state: str; why: Reason | None = None; ended: bool = False
class Halt(Effect): pass  # the tree; then `Halted`
class StopMachines(Effect): outcome: str  # all of them at the same time; then `Stood`
class Alarm(Effect): what: Reason
class KeepEnd(Effect): outcome: str; why: Reason | None  # in the checkpoint, before the end is told
class KeepInterrupted(Effect): pass  # the checkpoint, for a resume
class Forget(Effect): pass  # the checkpoint, after the end is stored
# fmt: on
