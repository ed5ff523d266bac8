"""A machine as a subtask sees it: all capabilities; one that the model lacks is refused with NO_CAPABILITY."""

from tms_core.acting import Cancelled, Progress
from tms_core.digging import Digging
from tms_core.driving import Driving
from tms_core.tipping import Tipping

__all__ = ["Cancelled", "Machine", "Progress"]


class Machine(Digging, Driving, Tipping):
    """One machine during one goal."""
