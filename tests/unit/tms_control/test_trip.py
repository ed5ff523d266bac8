"""Trips of all models on the stand-in of OperaSim-PhysX: they arrive, whatever the yaw gain, and end as they should."""

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest

from driven_tracks import GAINS, MODELS, TICK, DrivenTracks
from tms_control.ground import Body
from tms_control.path import Path, Piece, Pose
from tms_control.planner import Goal
from tms_control.reasons import (
    BlockedArea,
    GoalTaken,
    LeftPath,
    MachineThere,
    NoProgress,
    PathBlocked,
    PosesStopped,
    ShortOfPose,
    Silenced,
)
from tms_control.track_estimate import ZERO
from tms_control.trip import PATIENCE_FOR_POSES, PAUSE, TRIES, Trip
from tms_control.trip_task import Task
from tms_control.verdict import Ending, Verdict

WAYPOINTS = (Pose(1, 3, 2.5), Pose(12, 6, 1.2), Pose(4, 8, 3.1), Pose(6, 8, 3.1), Pose(0, 0, 0))
ARRIVED, CANCELED = Verdict(Ending.SUCCEEDED), Verdict(Ending.CANCELED)


def at(machine: DrivenTracks, pose: Pose) -> bool:
    return machine.pose.away(pose) <= 0.3 and abs(machine.pose.off(pose.yaw)) <= 0.1


def drive_to(machine: DrivenTracks, pose: Pose) -> Trip:
    trip = machine.trip(Task.to(pose))
    machine.run(trip)
    assert trip.verdict == ARRIVED
    assert at(machine, pose)
    return trip


def meet(machine: DrivenTracks, waypoints: tuple[Pose, ...] = WAYPOINTS) -> None:
    """Each waypoint is met, from the first move on, and the machine stands there."""
    trip = machine.trip(Task.waypoints(waypoints))
    for number, pose in enumerate(waypoints):
        machine.run(trip, until=lambda at=number: trip.feedback(machine.now).waypoint > at)
        assert at(machine, pose), f"waypoint {number} {pose}: {machine.pose}"
        assert machine.speed == 0.0
    assert (trip.verdict, trip.missed) == (ARRIVED, [])
    assert machine.sent[-1] == ZERO


@pytest.mark.parametrize("gain", GAINS)
@pytest.mark.parametrize("model", MODELS)
def test_waypoints(model: str, gain: float) -> None:
    machine = DrivenTracks(model, gain)
    meet(machine)
    assert max(abs(one.v) for one in machine.sent) <= machine.drive.velocity
    assert max(abs(one.w) for one in machine.sent) <= machine.drive.turn_velocity


@pytest.mark.parametrize("gain", GAINS)
@pytest.mark.parametrize(("model", "pivot"), [("ic120", -0.5), ("zx200", 0.4)])
def test_a_machine_that_does_not_turn_round_the_place_of_its_pose(model: str, pivot: float, gain: float) -> None:
    meet(DrivenTracks(model, gain, pivot=pivot))


@pytest.mark.parametrize("lag", [0.7, 1.4])
def test_a_lag_that_is_not_the_known_one(lag: float) -> None:
    meet(DrivenTracks("zx200", 1 / 3, lag=lag))


@pytest.mark.parametrize("control", [1, 15])
def test_a_clock_that_runs_five_times_slower_or_three_times_faster_than_ours(control: int) -> None:
    meet(DrivenTracks("ic120", 1.0, control=control))


def test_poses_that_jitter() -> None:
    meet(DrivenTracks("zx120", 0.6, jitter=0.003))


@pytest.mark.parametrize("model", MODELS)
def test_poses_that_are_only_passed(model: str) -> None:
    machine, poses = DrivenTracks(model), [Pose(8, 0, 0), Pose(14, 3, 0), Pose(16, 9, 0), Pose(16, 16, 1.5)]
    trip, left = machine.trip(Task.through(poses)), []
    machine.run(trip, until=lambda: bool(left.append(trip.feedback(machine.now).poses_left)))
    assert trip.verdict == ARRIVED
    assert [4, 3, 2, 1] == [one for i, one in enumerate(left) if i == 0 or one != left[i - 1]]
    assert all(min(pose.away(been) for been in machine.been) < 0.3 for pose in poses)
    assert at(machine, poses[-1])
    began = next(i for i, one in enumerate(machine.sent) if one != ZERO)
    ended = next(i for i, one in enumerate(machine.sent) if i > began and one == ZERO)
    assert machine.been[int(ended * 2.5)].away(poses[-1]) < 0.3, "it has stopped on the way"


@pytest.mark.parametrize("gain", GAINS)
def test_a_short_way_back_is_taken_in_reverse(gain: float) -> None:
    machine = DrivenTracks("ic120", gain)
    drive_to(machine, Pose(-4, 0.5, 0))
    assert min(one.v for one in machine.sent) < -0.2 and max(one.v for one in machine.sent) < 0.2


def test_feedback_counts_down() -> None:
    machine = DrivenTracks("zx200")
    trip, told = machine.trip(Task.to(Pose(10, 0, 0))), []
    machine.run(trip, until=lambda: bool(told.append(trip.feedback(machine.now))))
    driving = [one for one in told if one.pose.x > 0.1]
    assert all(one.left == pytest.approx(10 - one.pose.x, abs=0.2) for one in driving)
    assert driving[0].seconds_left == pytest.approx(10.0, abs=1.0)
    assert max(one.speed for one in told) == pytest.approx(machine.drive.velocity, abs=0.2)
    assert told[-1].speed == pytest.approx(0.0, abs=0.05)
    assert (told[-1].seconds, told[-1].left) == pytest.approx((machine.now, 0.0), abs=0.1)


def test_the_time_that_is_left_counts_down_also_in_turns() -> None:
    machine = DrivenTracks("zx200")
    trip, told = machine.trip(Task.to(Pose(0, 4, 0))), []
    machine.run(trip, until=lambda: bool(told.append(trip.feedback(machine.now))))
    assert max(one.seconds_left for one in told) == pytest.approx(machine.now, abs=8.0)
    assert max(one.seconds_left for one in told if one.pose.y > 3.9) < 15.0


def test_there_and_back_is_progress() -> None:
    """Two turns on the spot end where they have begun."""
    turn = Piece(Pose(0, 0, 0), 0.0, 0.55)
    way = Piece(turn.end, 0.3, 0.0)
    back = Piece(way.end, 0.0, -0.55)
    path = Path((turn, way, back, Piece(back.end, 2.0, 0.0)))
    machine = DrivenTracks("zx200", 1 / 3)
    trip = machine.trip(Task.along(path))
    machine.run(trip)
    assert trip.verdict == ARRIVED and at(machine, path.end)


def test_a_round_trip_is_driven() -> None:
    machine = DrivenTracks("zx200")
    trip = machine.trip(Task.through([Pose(5, 0, 0), Pose(0, 0, 0)]))
    machine.run(trip)
    assert trip.verdict == ARRIVED and at(machine, Pose(0, 0, 0))
    assert max(one.x for one in machine.been) > 4.7


def test_a_way_that_is_planned_anew_does_not_go_back_to_what_has_been_passed() -> None:
    machine = DrivenTracks("zx200")
    trip = machine.trip(Task.through([Pose(5, 0, 0), Pose(15, 0, 0)]))
    machine.run(trip, until=lambda: machine.pose.x > 6)
    machine.kick(0.0, beside=1.0)
    machine.run(trip)
    assert trip.verdict == ARRIVED and at(machine, Pose(15, 0, 0))
    after = machine.been[next(i for i, one in enumerate(machine.been) if one.y > 0.5) :]
    assert min(one.x for one in after) > 5.9


TOLD = Path((Piece(Pose(0, 0, 0), 5.0, 0.0), Piece(Pose(5, 0, 0), 8.0, 1.0)))


@pytest.mark.parametrize("gain", GAINS)
def test_a_told_path_is_followed(gain: float) -> None:
    machine = DrivenTracks("zx200", gain)
    trip = machine.trip(Task.along(TOLD))
    machine.run(trip)
    assert trip.verdict == ARRIVED and at(machine, TOLD.end)
    assert all(min(pose.away(been) for been in machine.been) < 0.3 for pose in TOLD.poses(1.0))


def test_off_a_told_path_the_goal_ends() -> None:
    machine = DrivenTracks("zx200")
    trip = machine.trip(Task.along(TOLD))
    machine.run(trip, until=lambda: machine.pose.x > 2)
    machine.kick(0.0, beside=1.0)
    machine.run(trip)
    assert trip.verdict is not None and isinstance(trip.verdict.reason, LeftPath)
    assert trip.verdict.ending is Ending.ABORTED and machine.speed == 0.0


def test_short_of_the_end_of_a_told_path_it_has_not_arrived() -> None:
    machine = DrivenTracks("zx200")
    trip = machine.trip(Task.along(TOLD))
    machine.run(trip, until=lambda: machine.pose.away(TOLD.end) < 0.1)
    machine.kick(0.0, beside=0.5)
    machine.run(trip)
    assert trip.verdict is not None and isinstance(trip.verdict.reason, ShortOfPose)


def test_at_the_end_of_a_told_path_it_turns_to_the_heading_there() -> None:
    machine = DrivenTracks("zx200")
    trip = machine.trip(Task.along(TOLD))
    machine.run(trip, until=lambda: machine.pose.away(TOLD.end) < 0.1)
    machine.kick(0.2)
    machine.run(trip)
    assert trip.verdict == ARRIVED and at(machine, TOLD.end)


@pytest.mark.parametrize("beside", [0.0, 1.0])
def test_kicked_while_it_drives(beside: float) -> None:
    machine = DrivenTracks("zx200")
    trip = machine.trip(Task.to(Pose(10, 0, 0)))
    machine.run(trip, until=lambda: machine.pose.x > 4)
    machine.kick(0.3, beside)
    machine.run(trip)
    assert trip.verdict == ARRIVED and at(machine, Pose(10, 0, 0))


@pytest.mark.parametrize("model", MODELS)
def test_kicked_while_it_stands(model: str) -> None:
    """A swing turns the base between two goals, and once more just before it would say that it has arrived."""
    machine = DrivenTracks(model)
    drive_to(machine, Pose(3, 0, 0))
    machine.kick(0.4)
    trip = machine.trip(Task.to(Pose(8, 0, 0)))
    machine.run(trip, until=lambda: machine.pose.away(Pose(8, 0, 0)) < 0.1 and machine.speed == 0.0)
    assert trip.verdict is None
    machine.kick(0.2, beside=0.1)
    begun = len(machine.been)
    machine.run(trip)
    assert trip.verdict == ARRIVED and at(machine, Pose(8, 0, 0))
    assert all(-0.1 < one.yaw < 0.25 for one in machine.been[begun:]), "it has driven off to come back"


def test_missing_poses_do_not_stop_it_at_once_and_then_do() -> None:
    machine = DrivenTracks("ic120")
    trip = machine.trip(Task.to(Pose(10, 0, 0)))
    machine.run(trip, until=lambda: machine.pose.x > 3)
    machine.blind, begun = True, len(machine.sent)
    machine.run(trip, 0.4)
    assert ZERO not in machine.sent[begun:]
    machine.run(trip, 0.3)
    assert machine.sent[-1] == ZERO and machine.speed == 0.0
    machine.run(trip, 9.0)
    assert set(machine.sent[-150:]) == {ZERO}
    machine.blind = False
    machine.run(trip)
    assert trip.verdict == ARRIVED and at(machine, Pose(10, 0, 0))


def test_time_without_poses_is_no_lack_of_progress() -> None:
    machine = DrivenTracks("ic120")
    trip = machine.trip(Task.to(Pose(10, 0, 0)))
    machine.run(trip, until=lambda: machine.pose.x > 3)
    machine.stuck = machine.blind = True
    machine.run(trip, 9.0)
    machine.blind = False
    machine.run(trip, 4.0)
    machine.stuck = False
    machine.run(trip)
    assert trip.verdict == ARRIVED


@pytest.mark.parametrize("x", [-1.0, 3.0])
def test_without_poses_the_goal_ends(x: float) -> None:
    machine = DrivenTracks("ic120")
    trip = machine.trip(Task.waypoints((Pose(10, 0, 0), Pose(0, 0, 0))))
    machine.run(trip, until=lambda: machine.pose.x > x)
    machine.blind, since = True, machine.now
    machine.run(trip)
    assert trip.verdict is not None and isinstance(trip.verdict.reason, PosesStopped)
    assert machine.now == pytest.approx(since + PATIENCE_FOR_POSES, abs=1.0)
    assert machine.sent[-1] == ZERO and machine.speed == 0.0 and not trip.missed


def test_a_clock_that_jumps_ahead() -> None:
    machine = DrivenTracks("zx200", 0.6)
    trip = machine.trip(Task.to(Pose(6, 4, 0)))
    for _ in range(5):
        machine.run(trip, 4.0)
        machine.now += 3.0
    machine.run(trip)
    assert trip.verdict == ARRIVED and at(machine, Pose(6, 4, 0))


@pytest.mark.parametrize("model", MODELS)
def test_a_cancel_ramps_down(model: str) -> None:
    machine = DrivenTracks(model)
    trip = machine.trip(Task.to(Pose(20, 0, 0)))
    machine.run(trip, until=lambda: machine.pose.x > 5)
    assert machine.speed > 0.9
    trip.cancel()
    speeds: list[float] = []  # at each tick
    while trip.verdict is None and len(speeds) * TICK < 5.0:
        speeds.append(machine.speed)
        machine.tick(trip)
    assert trip.verdict == CANCELED and machine.speed == 0.0 and machine.sent[-1] == ZERO
    steps = [a - b for a, b in pairwise(speeds) if a > 0.15]
    assert max(steps) < 2.5 * machine.drive.acceleration * 0.02, "it has braked hard"


def again(trip: Trip) -> bool:
    trip.cancel()
    return False


def test_a_cancel_that_is_repeated_at_each_step_ends_it_too() -> None:
    """As without the gateway: the controller asks again and again."""
    machine = DrivenTracks("zx200")
    trip = machine.trip(Task.to(Pose(20, 0, 0)))
    machine.run(trip, until=lambda: machine.pose.x > 5)
    machine.run(trip, 10.0, until=lambda: again(trip))
    assert trip.verdict == CANCELED and machine.speed == 0.0


def test_a_cancel_counts_even_if_poses_stop() -> None:
    machine = DrivenTracks("zx200")
    trip = machine.trip(Task.to(Pose(20, 0, 0)))
    machine.run(trip, 5.0)
    trip.cancel()
    machine.blind = True
    machine.run(trip)
    assert trip.verdict == CANCELED and machine.speed == 0.0


def test_silence() -> None:
    machine = DrivenTracks("zx200")
    trip = machine.trip(Task.to(Pose(20, 0, 0)))
    machine.run(trip, 5.0)
    trip.silence(machine.now)
    assert trip.verdict == Verdict(Ending.ABORTED, Silenced())
    assert machine.estimate.at(machine.now + 1.0).stands
    sent = len(machine.sent)
    for _ in range(100):
        machine.tick(trip)
    assert len(machine.sent) == sent


def test_no_progress_ends_a_goal() -> None:
    machine = DrivenTracks("zx200")
    trip = machine.trip(Task.through([Pose(5, 0, 0), Pose(10, 0, 0)]))
    machine.run(trip, until=lambda: machine.pose.x > 2)
    machine.stuck, since = True, machine.now
    machine.run(trip)
    assert trip.verdict == Verdict(Ending.ABORTED, NoProgress(10.0))
    assert 8.0 < machine.now - since < 12.0 and machine.sent[-1] == ZERO


def test_waypoints_go_on_after_one_that_cannot_be_reached() -> None:
    machine, poses = DrivenTracks("zx200"), (Pose(3, 0, 0), Pose(9, 0, 0), Pose(6, 5, math.pi))
    trip = machine.trip(Task.waypoints(poses))
    machine.run(trip, until=lambda: machine.pose.x > 5)
    machine.stuck = True
    machine.run(trip, until=lambda: bool(trip.missed))
    machine.stuck = False
    machine.run(trip)
    assert [(one.number, one.why) for one in trip.missed] == [(1, NoProgress(10.0))]
    assert trip.verdict == ARRIVED and at(machine, poses[2])


def test_a_newer_goal_begins_with_a_ramp() -> None:
    machine = DrivenTracks("zx200")
    machine.run(machine.trip(Task.to(Pose(20, 0, 0))), 8.0)
    assert machine.speed > 0.8
    trip, sent = machine.trip(Task.to(Pose(5, 5, 1.0))), len(machine.sent)
    machine.run(trip, 0.5)
    assert all(one.v > 0.05 for one in machine.sent[sent:])
    machine.run(trip)
    assert trip.verdict == ARRIVED and at(machine, Pose(5, 5, 1.0))


def machine_at(x: float, y: float, half: float = 1.5) -> Body:
    corners = ((x - half, y - half), (x + half, y - half), (x + half, y + half), (x - half, y + half))
    return Body(MachineThere("ic120_1"), corners)


def least_gap(machine: DrivenTracks, body: Body) -> float:
    return float(body.gaps(machine.outline, np.array(machine.been)).min())


@pytest.mark.parametrize("gain", GAINS)
@pytest.mark.parametrize(("model", "pivot"), [("ic120", -0.5), ("zx200", 0.0), ("mst110cr", 0.0)])
def test_it_drives_around_what_stands_in_its_way(model: str, pivot: float, gain: float) -> None:
    machine, there = DrivenTracks(model, gain, pivot=pivot), machine_at(15, 0)
    machine.stands(there)
    drive_to(machine, Pose(30, 0, 0))
    assert least_gap(machine, there) > 0.1


def test_what_comes_into_the_way_stops_it_and_it_goes_on_around() -> None:
    machine, there = DrivenTracks("ic120"), machine_at(20, 0)
    trip = machine.trip(Task.to(Pose(35, 0, 0)))
    machine.run(trip, until=lambda: machine.pose.x > 8)
    machine.stands(there)
    machine.run(trip, until=lambda: machine.speed == 0.0)
    assert 12 < machine.pose.x < 16.5, "it stops before it, not at once"
    machine.run(trip)
    assert trip.verdict == ARRIVED and at(machine, Pose(35, 0, 0))
    assert least_gap(machine, there) > 0.1


def test_what_leaves_the_way_in_time_is_only_waited_for() -> None:
    machine = DrivenTracks("ic120")
    trip = machine.trip(Task.to(Pose(35, 0, 0)))
    machine.run(trip, until=lambda: machine.pose.x > 8)
    machine.stands(machine_at(14, 0))
    machine.run(trip, until=lambda: machine.speed == 0.0)
    machine.stands()
    machine.run(trip)
    assert trip.verdict == ARRIVED and max(abs(one.y) for one in machine.been) < 0.3


def test_what_comes_into_the_way_counts_for_no_attempt() -> None:
    machine = DrivenTracks("ic120")
    trip = machine.trip(Task.to(Pose(60, 0, 0)))
    for x in (8, 18, 28):
        machine.run(trip, until=lambda at=x: machine.pose.x > at)
        machine.stands(machine_at(x + 6, 0))
        machine.run(trip, until=lambda: machine.speed == 0.0)
        machine.stands()
    machine.run(trip, until=lambda: machine.pose.x > 45)
    machine.kick(0.0, beside=1.0)
    machine.run(trip)
    assert trip.verdict == ARRIVED and at(machine, Pose(60, 0, 0))


@pytest.mark.turns
def test_where_it_cannot_get_around_it_tries_three_times_and_tells_what_is_in_the_way() -> None:
    machine = DrivenTracks("ic120")
    walls = [
        Body(BlockedArea(name), ((-20, y), (60, y), (60, y + 1), (-20, y + 1))) for name, y in (("n", 3), ("s", -4))
    ]
    machine.stands(*walls)
    trip = machine.trip(Task.to(Pose(35, 0, 0)))
    machine.run(trip, until=lambda: machine.pose.x > 8)
    machine.stands(*walls, machine_at(16, 0))
    begun = machine.now
    machine.run(trip)
    assert trip.verdict is not None and isinstance(trip.verdict.reason, PathBlocked)
    assert trip.verdict.reason.by == MachineThere("ic120_1")
    assert TRIES * PAUSE < machine.now - begun < TRIES * PAUSE + 20
    assert machine.speed == 0.0 and machine.pose.x < 12.6


def test_a_cancel_while_it_waits_ends_it() -> None:
    machine = DrivenTracks("ic120")
    trip = machine.trip(Task.to(Pose(35, 0, 0)))
    machine.run(trip, until=lambda: machine.pose.x > 8)
    machine.stands(machine_at(14, 0))
    machine.run(trip, until=lambda: machine.speed == 0.0)
    trip.cancel()
    machine.run(trip, seconds=2.0)
    assert trip.verdict == CANCELED


ROAD = (Goal(20, 0, None), Goal(20, 20, None))


def test_a_road_is_followed() -> None:
    machine = DrivenTracks("ic120")
    trip = machine.trip(Task.to(Pose(0, 20, math.pi), ROAD))
    machine.run(trip)
    assert trip.verdict == ARRIVED and at(machine, Pose(0, 20, math.pi))
    for place in ROAD:
        assert min(pose.away(Pose(place.x, place.y, 0)) for pose in machine.been) < 0.5


def test_a_road_that_is_blocked_is_left() -> None:
    machine = DrivenTracks("ic120")
    machine.stands(machine_at(20, 0))
    trip = machine.trip(Task.to(Pose(0, 20, math.pi), ROAD))
    machine.run(trip)
    assert trip.verdict == ARRIVED and at(machine, Pose(0, 20, math.pi))


@pytest.mark.parametrize("end", [Trip.cancel, lambda trip: trip.silence(5.0)], ids=["cancel", "silence"])
def test_nobody_waits_for_the_way_of_a_goal_that_ends(end: Callable[[Trip], None]) -> None:
    machine = DrivenTracks("ic120")
    machine.stands(machine_at(14, 0))
    trip = machine.trip(Task.to(Pose(35, 0, 0)))
    machine.run(trip, until=lambda: trip.asked is not None)
    asked = trip.asked
    assert asked is not None and trip.waits_for(asked)
    end(trip)
    assert not trip.waits_for(asked)


def test_a_goal_that_is_taken_is_refused_and_nothing_moves() -> None:
    machine = DrivenTracks("ic120")
    machine.stands(machine_at(20, 0))
    trip = machine.trip(Task.to(Pose(20, 1, 0)))
    machine.run(trip)
    assert trip.verdict is not None and isinstance(trip.verdict.reason, GoalTaken)
    assert machine.pose == Pose(0, 0, 0)


def test_a_waypoint_that_is_taken_is_missed_and_the_next_one_met() -> None:
    machine = DrivenTracks("ic120")
    machine.stands(machine_at(20, 0))
    trip = machine.trip(Task.waypoints((Pose(20, 0, 0), Pose(6, 6, 1.0))))
    machine.run(trip)
    assert trip.verdict == ARRIVED and at(machine, Pose(6, 6, 1.0))
    assert [(one.number, type(one.why)) for one in trip.missed] == [(0, GoalTaken)]


def test_a_told_path_is_left_to_who_has_told_it() -> None:
    machine = DrivenTracks("ic120")
    trip = machine.trip(Task.along(Path((Piece(Pose(0, 0, 0), 30.0, 0.0),))))
    machine.run(trip, until=lambda: machine.pose.x > 8)
    machine.stands(machine_at(20, 0))
    machine.run(trip)
    assert trip.verdict is not None and isinstance(trip.verdict.reason, PathBlocked)
