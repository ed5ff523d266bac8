"""Drive to the place of a record and stand there."""

from tms_machine.places import Place
from tms_machine.subtask import Machine, Progress, subtask


@subtask(timeout=900)
def navigate_anywhere(machine: Machine, want: Place, progress: Progress) -> None:
    machine.navigate_to(progress, want.pose())
