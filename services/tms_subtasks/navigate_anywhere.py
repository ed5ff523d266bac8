"""Drive to the place of a record and stand there."""

from tms_kit.subtask import Machine, Progress, subtask
from tms_subtasks.records.places import PoseRecord


@subtask(timeout=900)
def navigate_anywhere(machine: Machine, want: PoseRecord, progress: Progress) -> None:
    machine.navigate_to(progress, want.pose())
