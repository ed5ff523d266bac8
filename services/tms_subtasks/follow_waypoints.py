"""Drive to each waypoint of a record in turn; one that is not reached is a failure that names it."""

from tms_kit.subtask import Machine, Progress, subtask
from tms_subtasks.records.places import PathRecord


@subtask(timeout=1800)
def follow_waypoints(machine: Machine, want: PathRecord, progress: Progress) -> None:
    machine.follow(progress, want.poses())
