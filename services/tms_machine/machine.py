"""A machine as a subtask sees it: all capabilities; one that the model lacks is refused with NO_CAPABILITY."""

from tms_machine.acting import Cancelled, Progress
from tms_machine.digging import Digging
from tms_machine.driving import Driving
from tms_machine.tipping import Tipping

__all__ = ["Cancelled", "Machine", "Progress"]


class Machine(Digging, Driving, Tipping):
    """One machine during one goal."""
