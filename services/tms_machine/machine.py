"""A machine as a subtask sees it: all capabilities; one that the model lacks is refused with NO_CAPABILITY."""

from tms_machine.acting import Progress, SubtaskCancelled
from tms_machine.digging import Digging
from tms_machine.navigating import Navigating
from tms_machine.tipping import Tipping

__all__ = ["Machine", "Progress", "SubtaskCancelled"]


class Machine(Digging, Navigating, Tipping):
    """One machine during one goal."""
