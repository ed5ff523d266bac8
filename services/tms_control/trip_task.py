"""What a goal of tracks asks, and what is told of it."""

from collections.abc import Sequence
from dataclasses import dataclass

from tms_control.path import Path, Pose
from tms_control.planner import Goal
from tms_reason.reason import Reason


@dataclass(frozen=True)
class Missed:
    """A waypoint that was not reached."""

    number: int  # from 0
    why: Reason


@dataclass(frozen=True)
class Task:
    """What a goal asks: stages, after each of which it stands. All goals of a stage but the last are only passed."""

    stages: tuple[tuple[Goal, ...], ...]
    goes_on: bool = False  # after a stage that cannot be reached
    told: Path | None = None  # the way to the only stage; planned is only what turns there have put it off
    road: bool = False  # the goals before the last of the only stage are places of roads: passed if that is possible

    @classmethod
    def to(cls, pose: Pose, road: Sequence[Goal] = ()) -> "Task":
        """NavigateToPose, over places of roads."""
        return cls(((*road, Goal(*pose)),), road=bool(road))

    def off_road(self) -> "Task":
        """The same by any way."""
        return Task(tuple(goals[-1:] for goals in self.stages))

    @classmethod
    def through(cls, poses: Sequence[Pose]) -> "Task":
        """NavigateThroughPoses: headings count at the last pose only."""
        return cls(((*(Goal(pose.x, pose.y, None) for pose in poses[:-1]), Goal(*poses[-1])),))

    @classmethod
    def waypoints(cls, poses: Sequence[Pose]) -> "Task":
        """FollowWaypoints."""
        return cls(tuple((Goal(*pose),) for pose in poses), goes_on=True)

    @classmethod
    def along(cls, path: Path) -> "Task":
        """FollowPath."""
        return cls(((Goal(*path.end),),), told=path)


@dataclass(frozen=True)
class Feedback:
    """How far a goal is."""

    pose: Pose
    speed: float  # m/s, of the base
    seconds: float  # s since it began
    left: float  # m to the end of the stage
    seconds_left: float  # s to the end of the stage
    waypoint: int  # number of the stage, from 0
    poses_left: int  # of the stage
