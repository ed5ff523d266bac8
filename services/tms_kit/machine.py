"""A machine as a subtask sees it: all capabilities; one that the model lacks is refused with NO_CAPABILITY."""

from tms_kit.acting import Progress, SubtaskCancelled
from tms_kit.blading import Blading
from tms_kit.digging import Digging
from tms_kit.navigating import Navigating
from tms_kit.permitting import Permitting
from tms_kit.tipping import Tipping

__all__ = ["Machine", "Progress", "SubtaskCancelled"]


class Machine(Blading, Digging, Navigating, Permitting, Tipping):
    """One machine during one goal."""
