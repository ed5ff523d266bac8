"""What an operator can do about a reason: the console shows it as a button, the command line as a command."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Remedy:
    """`name` is the name in the console; `command` and `text` are format strings over the reason's arguments.

    The command line shows both, the console the text alone: a command in a text would be shown there, too.
    """

    name: str
    command: str  # shell command; empty where only work by hand helps
    text: str  # English; the key of its Japanese text


REARM = Remedy("rearm", "tms rearm {machine}", "Look at the machine, then re-arm it")
ESCAPE = Remedy("escape", "tms rearm {machine} --escape", "If it stands outside, let it back in by slow motions")
RESUME = Remedy("resume", "tms resume {run}", "Resume the run, or abandon it")
GIVE_BACK = Remedy("give_back", "tms give-back {machine}", "Give the machine back")
CANCEL = Remedy("cancel", "tms cancel {run}", "Cancel the run that holds it")
PROCESSES = Remedy("processes", "tms ps", "See which processes run")
RESTART = Remedy("restart", "tms restart {process}", "Restart the process")
LOGS = Remedy("logs", "tms logs {process}", "Read the log of the process")
STATUS = Remedy("status", "tms status", "See what is wrong with the system")
TASKS = Remedy("tasks", "tms task list", "See which tasks there are")
TEMPLATES = Remedy("templates", "tms template list", "See which templates there are")
RECORDS = Remedy("records", "tms param list", "See which records there are")
ADD_RECORD = Remedy("records", "tms param set {record} --create FIELD=VALUE", "Add the record")
CORRECT_RECORD = Remedy("records", "tms param set {record} FIELD=VALUE", "Correct the record")
RUNS = Remedy("runs", "tms runs", "See which runs there are")
CHECK = Remedy("check", "tms check", "Check the configuration")
EDIT_TASK = Remedy("edit_task", "", "Correct the task in the editor and store it again")
EDIT_CONFIG = Remedy("edit_config", "", "Correct the file")
OTHER_FOLDER = Remedy("edit_config", "", "Set TMS_STATE to another folder")
RELEASE_STOP = Remedy("release_stop", "", "Release the software stop")
ENABLE = Remedy("enable_areas", "tms areas enable", "Look at the areas, then enable them")
INSPECT = Remedy("look", "", "Look at the machine and at its PC")
RETRY = Remedy("retry", "", "Try again in a moment")
