"""What happens to a run."""

from collections.abc import Sequence

from tms_decision.data import Event
from tms_reason.reason import Reason


# fmt: off
class Prepared(Event): pass  # its processes are there, and what is known of it is on the disk
class Held(Event): back: Reason | None = None  # its permits are held; why one of its machines may not move now
class Refused(Event): why: Reason  # before any machine has moved, or by a bug
class Ticked(Event): status: str = ""; why: Reason | None = None  # success, failure and its node; empty: it goes on
class EndAsked(Event): outcome: str; why: Reason | None = None
class StoppedOutside(Event): machine: str; cause: Reason  # and stays so until a person re-arms it
class Halted(Event): moves: bool  # the tree is halted; whether goals are open, or a machine is being stopped
class Stood(Event): unseen: Sequence[Reason]  # the receipts of all its machines are there; those that do not confirm
class Looked(Event): moves: bool; open: Sequence[str]  # ... and the names of the open goals
# fmt: on
