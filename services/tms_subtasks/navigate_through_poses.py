"""Drive through the poses of a record without a stop."""

from tms_kit.subtask import Machine, Progress, subtask
from tms_subtasks.records.places import PathRecord


@subtask(timeout=1800)
def navigate_through_poses(machine: Machine, want: PathRecord, progress: Progress) -> None:
    machine.navigate_through(progress, want.poses())
