"""Why a PC cannot run, start or stop a process."""

from tms_reason.reason import Reason
from tms_reason.remedies import Remedy

SETUP = Remedy("setup", "make setup", "Install what is missing")


# fmt: off
class NoProgram(Reason, text="the program {file} is missing", action=SETUP): file: str
# fmt: on
