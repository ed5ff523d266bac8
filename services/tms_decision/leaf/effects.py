"""What the leaf goals of a run want to be done, in the order of the list."""

from tms_decision.data import Effect
from tms_decision.leaf.events import Key
from tms_decision.owner import Owner
from tms_reason.reason import Reason


# fmt: off
class Send(Effect): key: Key; call: int; owner: Owner  # a goal to its subtask; the checkpoint notes it before
class Cancel(Effect): call: int  # also before it is accepted
class Lose(Effect): call: int; dead: bool  # it never ends; `dead`: the process behind its server has ended
class StopMachine(Effect): machine: str; cause: Reason  # which may have been left moving; then `MachineStopped`
class Note(Effect): kind: str; node: str; what: Reason  # for the journal
class KeepSent(Effect): key: Key
class KeepDone(Effect): key: Key; succeeded: bool
class KeepGone(Effect): key: Key; left: int  # a later resume must not skip the last `left` ends of that goal
# fmt: on
