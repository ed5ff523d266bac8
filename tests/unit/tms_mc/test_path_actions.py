"""ComputePathToPose and the poses of FollowPath: what is refused, what is planned, and that both fit each other."""

import math
import threading
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from geometry_msgs.msg import PoseStamped
from nav2_msgs.action import ComputePathToPose, FollowPath, NavigateToPose
from nav_msgs.msg import Path

from driven_tracks import DrivenTracks
from tms_control.detour import Question
from tms_control.ground import Body, Ground, Outline
from tms_control.path import Pose, told
from tms_control.planner import Goal, Pace
from tms_control.reasons import BlockedArea, GoalTaken
from tms_control.roads import Roads
from tms_control.trip_task import Task
from tms_control.verdict import Ending
from tms_mc.goal_poses import in_map, pose_of, refuse
from tms_mc.path_server import FAILED, STEP, PathServer
from tms_mc.reasons import AreaUnfit, NoPoses, PosesUnheard, PoseUnfit, StrangeFrame
from tms_mc.surroundings import Surroundings
from tms_mc.tracks import Tracks
from tms_reason.errors import SubtaskFailed
from tms_reason.reason import Reason
from tms_reason.wire import of
from tms_ros.goals import Ended, Outcome
from tms_ros.server import AnyGoal

PACE = Pace(1.0, 0.3)
NOT_CANCELLED = threading.Event()
NO_ROADS = Roads()
HERE, THERE = Pose(1.0, 2.0, 0.5), Pose(9.0, 5.0, 2.0)


@dataclass
class FakeTracks:
    """Tracks that stand, or of which nothing is heard."""

    silent: Reason | None = None
    pose: Pose = HERE

    def unready(self) -> Reason | None:
        return self.silent

    def question(self, start: Pose, goals: Sequence[Goal], ground: Ground) -> Question:
        return Question(start, tuple(goals), PACE, 0.0, Outline.rectangle(2.0, -2.0, 1.5, -1.5), ground)


@dataclass
class FakeSurroundings:
    """What stands around them; or why nobody knows what is blocked."""

    bodies: tuple[Body, ...] = ()
    unfit: Reason | None = None
    roads: Roads = NO_ROADS

    def read(self, here: object) -> None:
        if self.unfit is not None:
            raise SubtaskFailed(self.unfit)

    def ground(self) -> Ground:
        return Ground(self.bodies)


def compute(
    tracks: FakeTracks,
    request: ComputePathToPose.Goal,
    around: FakeSurroundings | None = None,
    cancelled: threading.Event = NOT_CANCELLED,
) -> Ended[Any]:
    server = PathServer(cast(Tracks, tracks), cast(Surroundings, around or FakeSurroundings()))
    assert server.refuse(request) is None
    return server.run(cast(AnyGoal, SimpleNamespace(request=request, cancelled=cancelled)))


def planned(tracks: FakeTracks, request: ComputePathToPose.Goal) -> list[Pose]:
    outcome, result = compute(tracks, request)
    assert outcome is Outcome.SUCCEEDED
    assert result.path.header.frame_id == "map"
    return [pose_of(one) for one in result.path.poses]


def near(one: Pose, other: Pose) -> bool:
    return one.away(other) < 1e-6 and abs(one.off(other.yaw)) < 1e-6


def test_a_path_leads_from_where_the_machine_is_to_the_goal() -> None:
    ahead = in_map(Pose(50.0, 50.0, 0.0))
    poses = planned(FakeTracks(), ComputePathToPose.Goal(goal=in_map(THERE), start=ahead))
    assert near(poses[0], HERE) and near(poses[-1], THERE)
    assert max(a.away(b) for a, b in pairwise(poses)) <= STEP + 1e-6


def test_a_path_leads_from_the_start_that_is_given_also_without_a_machine() -> None:
    start = Pose(-3.0, 0.0, 1.0)
    goal = ComputePathToPose.Goal(goal=in_map(THERE), start=in_map(start), use_start=True)
    assert near(planned(FakeTracks(PosesUnheard("/zx200/pose")), goal)[0], start)


def test_without_a_place_of_the_machine_there_is_no_path() -> None:
    outcome, result = compute(FakeTracks(PosesUnheard("/zx200/pose")), ComputePathToPose.Goal(goal=in_map(THERE)))
    assert outcome is Outcome.ABORTED and not result.path.poses
    if hasattr(result, "error_code"):
        assert (result.error_code, of(result.error_msg)) == (FAILED, PosesUnheard("/zx200/pose"))


def square(x: float, y: float, half: float = 1.0) -> Body:
    corners = ((x - half, y - half), (x + half, y - half), (x + half, y + half), (x - half, y + half))
    return Body(BlockedArea("pit"), corners)


def test_a_path_leads_around_what_stands_there() -> None:
    goal, pit = ComputePathToPose.Goal(goal=in_map(Pose(20.0, 2.0, 0.0))), square(10.0, 2.0)
    outcome, result = compute(FakeTracks(pose=Pose(0.0, 2.0, 0.0)), goal, FakeSurroundings((pit,)))
    assert outcome is Outcome.SUCCEEDED
    poses = np.array([pose_of(one) for one in result.path.poses])
    assert pit.gaps(Outline.rectangle(2.0, -2.0, 1.5, -1.5), poses).min() > 0.3


def test_along_a_road_where_that_is_free() -> None:
    goal = ComputePathToPose.Goal(goal=in_map(Pose(60.0, 60.0, math.pi / 2)))
    road = Roads((((0.0, 0.0), (60.0, 0.0), (60.0, 60.0)),))
    tracks = FakeTracks(pose=Pose(0.0, 0.0, 0.0))
    _, along = compute(tracks, goal, FakeSurroundings(roads=road))
    assert min(math.dist((one.pose.position.x, one.pose.position.y), (60.0, 0.0)) for one in along.path.poses) < 0.1
    blocked = FakeSurroundings((square(60.0, 0.0),), roads=road)
    outcome, across = compute(tracks, goal, blocked)
    assert outcome is Outcome.SUCCEEDED and len(across.path.poses) < 0.8 * len(along.path.poses)


def test_a_search_ends_with_a_cancel() -> None:
    goal, over = ComputePathToPose.Goal(goal=in_map(Pose(20.0, 2.0, 0.0))), threading.Event()
    over.set()
    around = FakeSurroundings((square(10.0, 2.0),))
    outcome, _ = compute(FakeTracks(pose=Pose(0.0, 2.0, 0.0)), goal, around, over)
    assert outcome is Outcome.CANCELED


@pytest.mark.parametrize(
    "around", [FakeSurroundings((square(9.0, 5.0),)), FakeSurroundings(unfit=AreaUnfit("pit", 3, 50))]
)
def test_a_path_that_cannot_be_planned_is_refused_with_its_reason(around: FakeSurroundings) -> None:
    outcome, result = compute(FakeTracks(), ComputePathToPose.Goal(goal=in_map(THERE)), around)
    assert outcome is Outcome.ABORTED and not result.path.poses
    if hasattr(result, "error_code"):
        assert result.error_code == FAILED and isinstance(of(result.error_msg), (GoalTaken, AreaUnfit))


def test_the_path_that_is_told_is_the_one_that_will_be_followed() -> None:
    poses = planned(FakeTracks(), ComputePathToPose.Goal(goal=in_map(THERE)))
    followed = told(poses)
    assert followed.pieces[0].start.away(HERE) < 1e-3
    assert followed.end.away(THERE) < 0.02 and abs(followed.end.off(THERE.yaw)) < 0.02


@pytest.mark.parametrize(("name", "pivot"), [("zx200", 0.0), ("ic120", -0.5), ("mst110cr", 0.0)])
@pytest.mark.parametrize("goal", [Pose(8.0, 3.0, 1.0), Pose(-3.0, 0.5, 0.0), Pose(0.0, 6.0, -2.0), Pose(0.0, 0.0, 2.0)])
def test_a_planned_path_is_followed_to_its_end(name: str, pivot: float, goal: Pose) -> None:
    machine = DrivenTracks(name, pivot=pivot)
    start = machine.pose
    poses = planned(FakeTracks(pose=start), ComputePathToPose.Goal(goal=in_map(goal)))
    trip = machine.trip(Task.along(told(poses)))
    machine.run(trip)
    assert trip.verdict is not None and trip.verdict.ending is Ending.SUCCEEDED, trip.verdict
    assert machine.pose.away(goal) <= 0.3 and abs(machine.pose.off(goal.yaw)) <= 0.35


def stamped(frame: str, x: float = 0.0) -> PoseStamped:
    found = in_map(Pose(x, 0.0, 0.0))
    found.header.frame_id = frame
    return found


def path(frame: str, *poses: PoseStamped) -> FollowPath.Goal:
    made = Path(poses=list(poses))
    made.header.frame_id = frame
    return FollowPath.Goal(path=made)


@pytest.mark.parametrize(
    ("goal", "why"),
    [
        (path("map", stamped("map"), stamped("")), None),
        (path("world", stamped("")), None),
        (path("map"), NoPoses()),
        (path("odom", stamped("map"), stamped("")), StrangeFrame(1, "odom")),
        (path("map", stamped("odom")), StrangeFrame(0, "odom")),
        (path("map", stamped("map", math.nan)), PoseUnfit(0)),
        (NavigateToPose.Goal(pose=stamped("map", math.inf)), PoseUnfit(0)),
        (NavigateToPose.Goal(pose=stamped("map")), None),
    ],
)
def test_a_goal_to_drive_names_poses_in_the_map(goal: Any, why: Reason | None) -> None:
    assert refuse(goal) == why


@pytest.mark.parametrize("use_start", [True, False])
def test_a_start_counts_only_if_it_is_used(use_start: bool) -> None:
    goal = ComputePathToPose.Goal(goal=stamped("map"), start=stamped("odom"), use_start=use_start)
    assert PathServer.refuse(goal) == (StrangeFrame(1, "odom") if use_start else None)
    assert PathServer.refuse(ComputePathToPose.Goal(goal=stamped("odom"))) == StrangeFrame(0, "odom")
