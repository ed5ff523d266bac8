"""One goal of tracks: drives to poses or along a told path, and judges how it goes. Pure logic.

The machine stands before a way is planned, and stands again before it is measured whether it has arrived. If it has
not, the rest is planned anew. Where the fastest way is not free it goes on to stand, and asks for another one: to
search one takes longer than a step. What comes into the way while it drives stops it; then the rest is planned anew, a
few times. Times are seconds of the machine's clock.
"""

from collections.abc import Sequence
from dataclasses import replace

from tms_config.models import Drive
from tms_control.detour import Question, in_the_way
from tms_control.ground import Ground, Outline
from tms_control.path import Path, Piece, Pose
from tms_control.planner import Goal, Pace, Plan
from tms_control.progress import PATIENCE, Progress
from tms_control.pursuit import Pursuit
from tms_control.reasons import LeftPath, NoProgress, PathBlocked, PosesStopped, ShortOfPose, Silenced
from tms_control.track_estimate import ZERO, Command, PoseSample, TrackEstimate, TrackState
from tms_control.track_servo import TrackServo
from tms_control.trip_task import Feedback, Missed, Task
from tms_control.verdict import Ending, Verdict
from tms_control.way_check import blocked
from tms_reason.reason import Reason

OLD = 0.5  # s, age of a pose from which on the machine stands
PATIENCE_FOR_POSES = 10.0  # s without a pose, after which a goal ends
NEAR, ALIGNED = 0.25, 0.08  # m, rad: less off the goal is arrived; a waypoint is to be met by 0.3 m and 0.1 rad
BESIDE, ASKEW = 0.8, 0.8  # m, rad off the path, from which on it is given up
ATTEMPTS = 4  # ways that are planned to one goal, before it counts as one that cannot be reached
STANDS = 0.3  # s with poses that show it standing
TRIES = 3  # times that a stage is planned anew because something came into the way
PAUSE = 2.0  # s before each: most of what drives by is gone then
AT_ONCE = 8  # goals for which the fastest path is found within a step
CANCELLED = Verdict(Ending.CANCELED)


class Trip:
    """`verdict` is None until the goal has ended. One TrackEstimate serves all trips of a machine: it learns.

    `asked` is a way that has to be searched, for `answer`; `ground`: what stands around, as `see` tells it later;
    `arm`: as a Question has it.
    """

    def __init__(
        self, task: Task, drive: Drive, estimate: TrackEstimate, now: float, outline: Outline, ground: Ground,
        arm: Outline | None = None,
    ) -> None:  # fmt: skip
        self.verdict: Verdict | None = None
        self.missed: list[Missed] = []
        self.asked: Question | None = None
        self._outline, self._ground, self._arm = outline, ground, arm
        self._blocked: PathBlocked | None = None  # what came into the way of the present stage last
        self._tries, self._resumes = 0, now  # plans of this stage after that; s, not before that time
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

    def limit(self, speed: float) -> None:
        """Go no faster than this [m/s] from now on, and turn slower by the same share."""
        self._servo.fastest = min(speed, self._drive.velocity)

    def cancel(self) -> None:
        """Ramp down; the goal ends as soon as the machine stands. Asked again, it goes on to come to stand."""
        if self._ending != CANCELLED:
            self._stop(CANCELLED)

    def silence(self, now: float) -> None:
        """End the goal, and send nothing from this moment: the gateway has stopped the machine."""
        if self.verdict is None:
            self._estimate.sent(now, ZERO)
            self.verdict = self._ending or Verdict(Ending.ABORTED, Silenced())

    def see(self, now: float, ground: Ground) -> None:
        """Take what stands around now, each body where it was told to be last."""
        self._ground = ground
        if self.verdict is None and self._pursuit is not None:
            state = self._estimate.at(now)
            coming = self._pursuit.coming(replace(state, pose=state.pose.ahead(self._pivot)), self._estimate.lag)
            contact = blocked(ground, self._outline.seen_from(self._pivot), coming)
            if contact is not None:
                self._give_way(now, PathBlocked(contact.name, in_the_way(contact)))

    @property
    def way(self) -> Path | None:
        """The path that it drives; None while it stands and searches, and after the goal."""
        return self._path if self._pursuit is not None and self.verdict is None else None

    def waits_for(self, asked: Question) -> bool:
        """Whether the answer to a question still matters: not after a cancel. From any thread."""
        return self.asked is asked and self.verdict is None

    def answer(self, now: float, found: Plan | Reason) -> None:
        """Take the way that was asked for, or why there is none."""
        if self.asked is None:
            return  # the goal ends meanwhile
        pivot, self.asked = self.asked.pivot, None
        if isinstance(found, Plan):
            self._set_off(found.path, found.reached[:-1], pivot)
        elif self._task.road:
            self._task, self._attempts = self._task.off_road(), self._attempts - 1
        elif self._blocked is not None and self._tries < TRIES:
            self._wait(now)
        else:
            self._give_up(self._blocked or found)

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
            self._go_on(now, state.pose)
        return command

    def _go_on(self, now: float, pose: Pose) -> None:
        if self._ending is not None:
            self.verdict = self._ending
            return
        if self.asked is not None or now < self._resumes:
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
            return self._set_off(self._task.told, (), 0.0)
        goals, pivot = tuple(self._goals(pose, turns)), self._estimate.pivot
        question = Question(pose, goals, self._pace(), pivot, self._outline, self._ground, self._arm)
        found = question.fastest() if len(goals) <= AT_ONCE else None
        if found is None:
            self.asked = question
        else:
            self._set_off(found.path, found.reached[:-1], pivot)
        return None

    def _set_off(self, path: Path, reached: tuple[int, ...], pivot: float) -> None:
        self._path, self._reached, self._pivot = path, reached, pivot
        self._pursuit, self._begun_pieces = Pursuit(path, self._drive, self._servo), 0
        self._progress.restart()

    def _give_way(self, now: float, why: PathBlocked) -> None:
        """Stop for something that has come into the way."""
        self._blocked = why
        if self._task.told is not None or self._tries >= TRIES:
            self._give_up(why)
        else:
            self._attempts -= 1  # it was not the machine that failed
            self._wait(now)
        self._rest()

    def _wait(self, now: float) -> None:
        self._tries, self._resumes = self._tries + 1, now + PAUSE

    def _goals(self, pose: Pose, turns: bool) -> Sequence[Goal]:
        goals = self._task.stages[self._stage]
        if turns:
            pivot = self._estimate.pivot
            turned = pose.ahead(pivot)._replace(yaw=goals[-1].yaw or 0.0)
            return [Goal(*turned.ahead(-pivot))]
        return goals[min(self._passed, len(goals) - 1) :]

    def _swerve(self) -> float:
        """How far turns on the spot of a told path, which is not that of the pivot, put the machine off [m]."""
        return 2 * abs(self._estimate.pivot) if self._task.told is not None else 0.0

    def _next_stage(self) -> None:
        if self._stage + 1 == len(self._task.stages):
            self._stop(Verdict(Ending.SUCCEEDED))
        else:
            self._stage, self._attempts, self._passed = self._stage + 1, 0, 0
            self._tries, self._blocked = 0, None
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
        self._pursuit, self._stands_since, self.asked = None, None, None

    def _pace(self) -> Pace:
        return Pace.of(self._drive, self._estimate.yaw_gain)


def _nothing(task: Task) -> Piece:
    """A path before one is planned."""
    goal = task.stages[0][-1]
    return Piece(Pose(goal.x, goal.y, goal.yaw or 0.0), 0.0, 0.0)
