"""One goal of tracks: drives to poses or along a told path, and judges how it goes. Pure logic.

The machine stands before a way is planned, and stands again before it is measured whether it has arrived. If it has
not, the rest is planned anew. Times are seconds of the machine's clock.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from tms_config.models import Drive
from tms_control.path import Path, Piece, Pose
from tms_control.planner import Goal, Pace, plan
from tms_control.progress import PATIENCE, Progress
from tms_control.pursuit import Pursuit
from tms_control.reasons import LeftPath, NoProgress, PosesStopped, ShortOfPose, Silenced
from tms_control.track_estimate import ZERO, Command, PoseSample, TrackEstimate, TrackState
from tms_control.track_servo import TrackServo
from tms_control.verdict import Ending, Verdict
from tms_reason.reason import Reason

OLD = 0.5  # s, age of a pose from which on the machine stands
PATIENCE_FOR_POSES = 10.0  # s without a pose, after which a goal ends
NEAR, ALIGNED = 0.25, 0.08  # m, rad: less off the goal is arrived; a waypoint is to be met by 0.3 m and 0.1 rad
BESIDE, ASKEW = 0.8, 0.8  # m, rad off the path, from which on it is given up
ATTEMPTS = 4  # ways that are planned to one goal, before it counts as one that cannot be reached
STANDS = 0.3  # s with poses that show it standing
CANCELLED = Verdict(Ending.CANCELED)


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

    @classmethod
    def to(cls, pose: Pose) -> "Task":
        """NavigateToPose."""
        return cls(((Goal(*pose),),))

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


class Trip:
    """`verdict` is None until the goal has ended. One TrackEstimate serves all trips of a machine: it learns."""

    def __init__(self, task: Task, drive: Drive, estimate: TrackEstimate, now: float) -> None:
        self.verdict: Verdict | None = None
        self.missed: list[Missed] = []
        self._task, self._drive, self._estimate, self._begun = task, drive, estimate, now
        self._servo = TrackServo(drive, estimate)
        self._progress = Progress()
        self._stage = self._attempts = 0
        self._passed = 0  # goals of the stage
        self._reached: tuple[int, ...] = ()  # pieces of the present path after which the other goals are reached
        self._path = Path((_nothing(task),))
        self._pursuit: Pursuit | None = None  # None: it shall stand
        self._pivot = 0.0  # m, that of the present path
        self._begun_pieces = 0  # of the path, behind it when the present one began
        self._stands_since: float | None = None
        self._seen = now  # s, when a pose was last young enough
        self._ending: Verdict | None = None  # once it stands

    def step(self, now: float, sample: PoseSample | None) -> Command | None:
        """The command to send now, with a pose that has come since the last step; None if nothing is to be sent."""
        if sample is not None:
            self._estimate.measured(sample)
        if self.verdict is not None:
            return None
        command = self._unseen(now) if self._estimate.age(now) > OLD else self._see(now)
        self._estimate.sent(now, command)
        return command

    def cancel(self) -> None:
        """Ramp down; the goal ends as soon as the machine stands. Asked again, it goes on to come to stand."""
        if self._ending != CANCELLED:
            self._stop(CANCELLED)

    def silence(self, now: float) -> None:
        """End the goal, and send nothing from this moment: the gateway has stopped the machine."""
        if self.verdict is None:
            self._estimate.sent(now, ZERO)
            self.verdict = self._ending or Verdict(Ending.ABORTED, Silenced())

    def feedback(self, now: float) -> Feedback:
        """How far it is."""
        state, goals = self._estimate.at(now), self._task.stages[self._stage]
        if self._pursuit is None:
            left = state.pose.away(Pose(goals[-1].x, goals[-1].y, 0.0))
            seconds = left / self._drive.velocity
        else:
            left = self._pursuit.left
            seconds = self._pace().total(self._path.pieces[self._pursuit.pieces_done :])
        poses_left = len(goals) - self._passed
        return Feedback(state.pose, abs(state.v), now - self._begun, left, seconds, self._stage, poses_left)

    def _unseen(self, now: float) -> Command:
        """Stand while nobody knows where it is."""
        self._progress.restart()
        self._stands_since = None
        if now - self._seen >= PATIENCE_FOR_POSES:
            self.verdict = self._ending or Verdict(Ending.ABORTED, PosesStopped(now - self._seen))
        return ZERO

    def _see(self, now: float) -> Command:
        self._seen, state = now, self._estimate.at(now)
        if self._pursuit is None:
            return self._stand(now, state)
        return self._follow(now, replace(state, pose=state.pose.ahead(self._pivot)), self._pursuit)

    def _follow(self, now: float, state: TrackState, pursuit: Pursuit) -> Command:
        off = pursuit.deviation(state)
        if pursuit.pieces_done != self._begun_pieces:
            self._begun_pieces = pursuit.pieces_done
            self._progress.restart()  # two turns, there and back, end where they began
        if self._progress.lacks(now, state.pose):
            self._give_up(NoProgress(PATIENCE))
        elif off.beside > BESIDE + self._swerve() or off.turned > ASKEW:
            self._give_up_way(LeftPath(off.beside, off.turned))
        else:
            command = pursuit.step(state)
            while self._reached and self._reached[0] <= pursuit.pieces_done:
                self._reached, self._passed = self._reached[1:], self._passed + 1
            if pursuit.done:
                self._rest()
            return command
        return self._servo.slow_down(state)

    def _stand(self, now: float, state: TrackState) -> Command:
        """Come to stand, and go on from there."""
        command = self._servo.slow_down(state)
        if not (state.stands and command == ZERO):
            self._stands_since = None
        elif self._stands_since is None:
            self._stands_since = now
        elif now - self._stands_since >= STANDS:
            self._go_on(state.pose)
        return command

    def _go_on(self, pose: Pose) -> None:
        if self._ending is not None:
            self.verdict = self._ending
            return
        goal = self._task.stages[self._stage][-1]
        away, turned = pose.away(Pose(goal.x, goal.y, 0.0)), abs(pose.off(goal.yaw or 0.0))
        if self._attempts and away <= NEAR and turned <= ALIGNED:
            self._next_stage()
        elif self._attempts >= (1 if self._task.told and away > NEAR + self._swerve() else ATTEMPTS):
            self._give_up(ShortOfPose(away, turned, self._attempts))
        else:
            self._begin(pose, turns=self._attempts > 0 and away <= NEAR)

    def _begin(self, pose: Pose, turns: bool) -> None:
        """Begin a way to the goals that are left; or only turn, where the machine is near enough."""
        self._attempts += 1
        if self._task.told is not None and self._attempts == 1:
            self._path, self._reached, self._pivot = self._task.told, (), 0.0
        else:
            self._pivot = self._estimate.pivot
            found = plan(pose, self._goals(pose, turns), self._pace(), self._pivot)
            self._path, self._reached = found.path, found.reached[:-1]
        self._pursuit, self._begun_pieces = Pursuit(self._path, self._drive, self._servo), 0
        self._progress.restart()

    def _goals(self, pose: Pose, turns: bool) -> Sequence[Goal]:
        goals = self._task.stages[self._stage]
        if turns:
            turned = pose.ahead(self._pivot)._replace(yaw=goals[-1].yaw or 0.0)
            return [Goal(*turned.ahead(-self._pivot))]
        return goals[min(self._passed, len(goals) - 1) :]

    def _swerve(self) -> float:
        """How far turns on the spot of a told path, which is not that of the pivot, put the machine off [m]."""
        return 2 * abs(self._estimate.pivot) if self._task.told is not None else 0.0

    def _next_stage(self) -> None:
        if self._stage + 1 == len(self._task.stages):
            self._stop(Verdict(Ending.SUCCEEDED))
        else:
            self._stage, self._attempts, self._passed = self._stage + 1, 0, 0
        self._rest()

    def _give_up_way(self, why: Reason) -> None:
        """Plan anew, if that may still help."""
        if self._task.told is not None or self._attempts >= ATTEMPTS:
            self._give_up(why)
        self._rest()

    def _give_up(self, why: Reason) -> None:
        if self._task.goes_on:
            self.missed.append(Missed(self._stage, why))
            self._next_stage()
        else:
            self._stop(Verdict(Ending.ABORTED, why))

    def _stop(self, verdict: Verdict) -> None:
        """End with a verdict once it stands."""
        self._ending = verdict
        self._rest()

    def _rest(self) -> None:
        self._pursuit, self._stands_since = None, None

    def _pace(self) -> Pace:
        return Pace.of(self._drive, self._estimate.yaw_gain)


def _nothing(task: Task) -> Piece:
    """A path before one is planned."""
    goal = task.stages[0][-1]
    return Piece(Pose(goal.x, goal.y, goal.yaw or 0.0), 0.0, 0.0)
