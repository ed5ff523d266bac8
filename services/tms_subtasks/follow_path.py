"""Drive along the path of a record, as the navigation or the planner has made it, and stand at its end."""

from tms_kit.subtask import Machine, Progress, subtask
from tms_subtasks.records.places import PathRecord


@subtask(timeout=1800)
def follow_path(machine: Machine, want: PathRecord, progress: Progress) -> None:
    machine.follow_path(progress, want.poses())
