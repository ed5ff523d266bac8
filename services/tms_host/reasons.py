"""Why a PC cannot run, start or stop a process, and how its processes are."""

from tms_reason.quantities import Megabytes, Seconds
from tms_reason.reason import Reason
from tms_reason.remedies import LOGS, OTHER_FOLDER, PROCESSES, RETRY, Remedy

SETUP = Remedy("setup", "make setup", "Install what is missing")
UP = Remedy("up", "make up", "Start it")
OTHER_RUNTIME_FOLDER = Remedy("edit_config", "", "Remove it, or set XDG_RUNTIME_DIR")
OTHER_PATH = Remedy("edit_config", "", "Choose another folder")


# fmt: off
# this PC
class NoProgram(Reason, text="the program {file} is missing", action=SETUP): file: str
class CannotBeWritten(Reason, text="cannot be written ({problem})", action=OTHER_FOLDER): problem: str
class NoRoom(Reason, text="only {free} free, {needed} are needed", action=OTHER_FOLDER):
    free: Megabytes; needed: Megabytes
class NotPrivate(Reason, text="{folder} is not private to you", action=OTHER_RUNTIME_FOLDER): folder: str
class PathQuoted(Reason, text="the path {path} holds a quote or a line break", action=OTHER_PATH): path: str

# supervisord
class MeshDown(Reason, text="the mesh does not run here", action=UP): pass
class SupervisordSays(Reason, text="supervisord refused: {words}", code="SUPERVISOR", details="{call}"):
    words: str; call: str
class SupervisordSilent(Reason, text="supervisord does not answer"): pass
class NoProcessHere(Reason, text="there is no process '{process}' on this PC", action=PROCESSES): process: str
class NotEnded(Reason, text="{process} was told to end {seconds} ago and has not", action=RETRY):
    process: str; seconds: Seconds
class LogUnreadable(Reason, text="the log of {process} cannot be read ({problem})", details="{path}"):
    process: str; problem: str; path: str
class BadCommand(Reason, text="'{command}' is none of start, stop, restart"): command: str

# how a process is
class NoPulse(Reason, text="no pulse for {seconds}: the host agent keeps the machine stopped", action=LOGS):
    seconds: Seconds; process: str
