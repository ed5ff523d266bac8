"""What areas mean for a machine: figures that can be worked out by hand."""

import math
import random
from pathlib import Path

import numpy as np
import pytest

from tms_areas import law as the_law
from tms_areas.areas import Area, AreaSet
from tms_areas.body import Body, Part, Silhouette
from tms_areas.braking import Axis, Tracks, tracks_of
from tms_areas.fix import Fix, Motion
from tms_areas.guard import Guard
from tms_areas.law import Law
from tms_areas.reasons import EntersArea, LeavesArea, NoWay, PoseJumped, PoseSettles, TooFastFor
from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse

SQUARE = Body((Part(np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]), math.sqrt(2)),))
TRACKS = Tracks(Axis(1.0, 0.5, 0.5), Axis(0.4, 0.4, 0.5))
YARD = Area("yard", "unmanned", ((-20, -20), (20, -20), (20, 20), (-20, 20)))
HUT = Area("hut", "manned", ((5, -2), (8, -2), (8, 2), (5, 2)))
SLOW = Area("slow", "speed_limit", ((-20, 10), (20, 10), (20, 20), (-20, 20)), speed=0.5)
PLACE = Area("place", "release", ((-10, -10), (-5, -10), (-5, -5), (-10, -5)), on_loss="stop")


def law(*areas: Area, tracks: Tracks | None = TRACKS) -> Law:
    return Law(AreaSet((YARD, *areas)), "ic120", tracks)


def ahead(x: float, speed: float = 1.0, tracks: Tracks = TRACKS, age: float = 0.05) -> bool:
    """Whether a machine that drives along x may go on."""
    return law(tracks=tracks).driving(SQUARE, Motion(x, 0.0, 0.0, speed, 0.0, 0.0, 0.1, age)) is None


def limit(speed: float, tracks: Tracks = TRACKS, age: float = 0.05) -> float:
    """The last x from which a machine may go on towards the border at x = 20."""
    near, far = 10.0, 20.0
    while far - near > 0.01:
        middle = (near + far) / 2
        near, far = (middle, far) if ahead(middle, speed, tracks, age) else (near, middle)
    return near


def test_a_machine_in_the_middle_goes_on() -> None:
    assert ahead(0.0)


def test_it_stops_where_it_can_still_brake_inside() -> None:
    needed = 1.0 * (0.05 + the_law.DELAY + the_law.BEAT) + TRACKS.forward.braking(1.0) + 0.1 + the_law.STRAY
    assert 20 - 1 - limit(1.0) >= needed
    assert 20 - 1 - limit(1.0) <= needed + 0.5  # what its corners turn meanwhile


@pytest.mark.parametrize(
    "worse",
    [
        Tracks(TRACKS.forward, TRACKS.turning, 0.4), Tracks(TRACKS.forward, TRACKS.turning, 0.0, 1.5),
        Tracks(Axis(1.0, 0.5, 1.0), TRACKS.turning), Tracks(Axis(1.0, 0.3, 0.5), TRACKS.turning),
    ],
)  # fmt: skip
def test_a_dead_time_worse_brakes_and_an_old_pose_ask_for_more_room(worse: Tracks) -> None:
    assert limit(1.0, worse) < limit(1.0) - 0.1
    assert limit(1.0, age=0.4) < limit(1.0) - 0.3
    assert limit(0.3) > limit(1.0) + 0.3


def test_away_from_a_border_it_may_leave_from_close_by() -> None:
    assert law().driving(SQUARE, Motion(18.3, 0.0, 0.0, -0.8, 0.0)) is None


def test_beside_a_border_it_drives_on() -> None:
    assert law().driving(SQUARE, Motion(0.0, 18.0, 0.0, 1.0, 0.0)) is None


def test_the_stop_says_which_border_is_how_far_and_how_far_it_needs() -> None:
    found = law().driving(SQUARE, Motion(18.0, 3.0, 0.0, 1.0, 0.0))
    assert isinstance(found, LeavesArea) and (found.machine, found.area) == ("ic120", "yard")
    assert (found.gap, found.x) == (pytest.approx(1.0), pytest.approx(20.0)) and found.needed > 1.0


def test_a_closed_area_is_not_entered() -> None:
    found = law(HUT).driving(SQUARE, Motion(3.5, 0.0, 0.0, 1.0, 0.0))
    assert isinstance(found, EntersArea) and found.area == "hut" and found.gap == pytest.approx(0.5)


def test_a_closed_area_inside_of_the_machine_is_entered() -> None:
    pole = Area("pole", "blocked", ((-0.1, -0.1), (0.1, -0.1), (0.1, 0.1)))
    assert isinstance(law(pole).driving(SQUARE, Motion(0.0, 0.0, 0.0)), EntersArea)


def test_a_release_area_is_open_to_its_holder_alone() -> None:
    at = Motion(-7.5, -7.5, 0.0)
    areas = AreaSet((YARD, PLACE))
    assert isinstance(Law(areas, "ic120", TRACKS).driving(SQUARE, at), EntersArea)
    assert Law(areas, "ic120", TRACKS, frozenset({"place"})).driving(SQUARE, at) is None


def test_a_speed_limit_holds_before_the_border_of_its_area() -> None:
    fast, slow = Motion(0.0, 8.5, 0.0, 0.0, 0.8), Motion(0.0, 8.5, 0.0, 0.0, 0.45)
    assert isinstance(law(SLOW).driving(SQUARE, fast), TooFastFor)
    assert law(SLOW).driving(SQUARE, slow) is None
    assert isinstance(law(SLOW).arriving(SQUARE, (0.0, 15.0, 0.0)), TooFastFor)  # nobody tells its speed


def obeying(*areas: Area) -> Law:
    """The law for tracks that take a speed limit."""
    return Law(AreaSet((YARD, *areas)), "ic120", TRACKS, slow=True)


def test_tracks_that_take_a_limit_may_drive_into_one() -> None:
    assert obeying(SLOW).arriving(SQUARE, (0.0, 15.0, 0.0)) is None
    assert isinstance(obeying(SLOW).driving(SQUARE, Motion(0.0, 8.5, 0.0, 0.0, 0.8)), TooFastFor)  # and obey it


def test_the_least_limit_nearby_counts() -> None:
    slower = Area("slower", "speed_limit", ((-20, 15), (20, 15), (20, 20), (-20, 20)), speed=0.2)
    assert (
        obeying().pace(SQUARE, Motion(0.0, 0.0, 0.0)) == obeying(SLOW).pace(SQUARE, Motion(0.0, -15.0, 0.0)) == math.inf
    )
    assert obeying(SLOW, slower).pace(SQUARE, Motion(0.0, 16.0, 0.0)) == pytest.approx(0.2 * the_law.HEEDED)
    assert law(SLOW, tracks=None).pace(SQUARE, Motion(0.0, 16.0, 0.0)) == math.inf


@pytest.mark.parametrize("late", [0.0, 1.0])
def test_tracks_that_obey_are_slow_in_time(late: float) -> None:
    found, y, speed, told = obeying(SLOW), -10.0, 1.0, [math.inf] * (1 + round(late / 0.04))
    while y < 15.0:
        motion = Motion(0.0, y, math.pi / 2, 0.0, speed, age=0.05)
        assert found.driving(SQUARE, motion) is None, (y, speed)
        told.append(found.pace(SQUARE, motion))
        speed = max(speed - 0.04 * 0.5 * TRACKS.forward.acceleration, min(speed, told.pop(0)))
        y += 0.04 * speed
    assert speed == pytest.approx(0.5 * the_law.HEEDED)
    assert law(SLOW).arriving(SQUARE, (0.0, 0.0, 0.0)) is None


def test_a_goal_must_leave_room_to_arrive() -> None:
    assert law().arriving(SQUARE, (17.0, 0.0, 0.0)) is None
    assert isinstance(law().arriving(SQUARE, (18.6, 0.0, 0.0)), LeavesArea)


def test_what_a_pose_is_off_is_planned_for() -> None:
    vague = 0.4
    assert law().arriving(SQUARE, (17.0, 0.0, 0.0), vague) is None
    near = next(x for x in np.arange(18.6, 17.0, -0.01) if law().arriving(SQUARE, (x, 0.0, 0.0)) is None)
    assert isinstance(law().arriving(SQUARE, (near, 0.0, 0.0), vague), LeavesArea)
    beside = [(0.0, 0.0, 0.0), (12.0, 0.0, 0.0)]
    walls = (law(Area("wall", "blocked", ((5, y), (8, y), (8, 6), (5, 6)))) for y in np.arange(1.0, 5.0, 0.02))
    free = next(one for one in walls if one.path(SQUARE, beside) is None)
    assert isinstance(free.path(SQUARE, beside, vague), EntersArea)


def test_a_path_is_refused_where_it_leads_through_a_closed_area() -> None:
    assert law(HUT).path(SQUARE, [(0.0, 0.0, 0.0), (12.0, 0.0, 0.0)]) is not None
    around = [(0.0, 0.0, 0.0), (0.0, 0.0, 1.57), (0.0, 7.0, 1.57), (0.0, 7.0, 0.0), (12.0, 7.0, 0.0)]
    assert law(HUT).path(SQUARE, around) is None
    backward = [(0.0, 0.0, math.pi), (12.0, 0.0, math.pi)]
    assert law(HUT).path(SQUARE, backward) is not None and law().path(SQUARE, backward) is None


def test_no_way_leads_from_one_unmanned_area_to_another_apart() -> None:
    far = Area("far", "unmanned", ((100, 0), (120, 0), (120, 20), (100, 20)))
    areas = law(far)
    assert areas.apart((0, 0, 0), (10, 10, 0)) is None
    assert areas.apart((0, 0, 0), (110, 10, 0)) == NoWay("ic120", 110, 10)


def test_without_tracks_only_its_arm_counts() -> None:
    fixed = law(tracks=None)
    assert fixed.working(SQUARE, Motion(18.8, 0.0, 0.0)) is None
    assert fixed.working(SQUARE, Motion(18.8, 0.0, 0.0), 0.5) is not None


def test_receipts_only_enlarge_the_distances() -> None:
    model = TRACKS.forward.braking(1.0)
    assert TRACKS.learned(1.0, 0.5 * model).factor == 1.0
    worse = TRACKS.learned(1.0, 1.5 * model)
    assert worse.factor == pytest.approx(1.5)
    assert worse.learned(1.0, model).factor == pytest.approx(1.5)
    assert TRACKS.learned(0.01, 10.0).factor == 1.0  # noise


# bodies of real models

MODELS = {path.stem: parse(path, MachineModel) for path in sorted(Path(CONFIGS / "machines").glob("*.yaml"))}


def extent(body: Body) -> float:
    return max(float(np.hypot(*part.corners.T).max()) for part in body.parts)


@pytest.mark.parametrize("name", MODELS)
def test_a_body_holds_the_footprint_of_its_model(name: str) -> None:
    model = MODELS[name]
    body = Silhouette(model).body([{joint: model.initial.get(joint, 0.0) for joint in model.joints}])
    reach = max(abs(one.max[0]) for one in model.footprint.values())
    assert max(float(part.corners[:, 0].max()) for part in body.parts) >= reach - 0.2
    assert tracks_of(model, model.borders["sim"]) is not None


def test_an_arm_that_stretches_needs_more_room_also_on_its_way() -> None:
    silhouette = Silhouette(MODELS["zx200"])
    folded = {"swing_joint": 0.0, "boom_joint": -1.1, "arm_joint": 2.6, "bucket_joint": 2.0, "bucket_end_joint": 0.0}
    stretched = {**folded, "boom_joint": -0.3, "arm_joint": 0.7}
    assert extent(silhouette.body([stretched])) > extent(silhouette.body([folded])) + 2.0
    assert extent(silhouette.swept([folded, stretched, folded])) >= extent(silhouette.body([stretched])) - 0.01
    assert extent(silhouette.body([{**folded, "swing_joint": 2.0}])) == pytest.approx(extent(silhouette.body([folded])))


def test_a_joint_that_is_not_told_may_be_anywhere() -> None:
    silhouette = Silhouette(MODELS["zx200"])
    assert extent(silhouette.body([{"swing_joint": 0.0}])) > 9.0


@pytest.mark.parametrize("tracks", [True, False])
@pytest.mark.parametrize("name", ["ic120", "zx200", "square"])  # which is small: its way is longer than itself
def test_where_no_border_is_near_a_full_look_finds_nothing_either(name: str, tracks: bool) -> None:
    r, known = random.Random(1), MODELS.get(name)
    silhouette = None if known is None else Silhouette(known)
    most = extent(SQUARE) if silhouette is None else silhouette.most
    yard = Area("yard", "unmanned", ((-40, -40), (40, -40), (40, 40), (-40, 40)))
    limits = Law(AreaSet((yard, HUT, SLOW)), name, TRACKS if known is None else tracks_of(known, known.borders["sim"]))
    clear = found = 0
    for _ in range(1500):
        place = r.uniform(-45, 45), r.uniform(-45, 45), r.uniform(-math.pi, math.pi)
        motion = Motion(*place, r.uniform(-1.5, 1.5), r.uniform(-0.3, 0.3), r.uniform(-0.4, 0.4), 0.1, 0.05)
        joints = {} if known is None else {joint: r.uniform(-math.pi, math.pi) for joint in known.joints}
        body, more = SQUARE if silhouette is None else silhouette.body([joints]), r.choice([0.0, 0.5])
        wrong = limits.driving(body, motion) if tracks else limits.working(body, motion, more)
        near = not limits.clear(motion, most, more, tracks)
        assert near or wrong is None, motion
        clear, found = clear + (not near), found + (wrong is not None)
    assert clear > 100 and found > 100


# the watch


def guard(x: float, speed: float = 0.0) -> tuple[Guard, Fix, float]:
    """A watch over an ic120 that has told its place for a while."""
    model, fix = MODELS["ic120"], Fix(0.35)
    for i in range(20):
        fix.heard(i * 0.06, x + speed * i * 0.06, 0.0, 0.0)
    fix.look(20 * 0.06)
    return Guard(Law(AreaSet((YARD, HUT)), "ic120", TRACKS), Silhouette(model)), fix, 20 * 0.06


JOINTS = {"vessel_pin_joint": 0.0}


def test_tracks_are_held_while_the_place_is_not_believed_and_an_arm_goes_on() -> None:
    watch, fix, now = guard(0.0)
    assert watch.look(fix.look(now), JOINTS, tracks=True).hold is None
    fix.heard(now, 3.0, 0.0, 0.0)
    now += 0.1
    held = watch.look(fix.look(now), JOINTS, tracks=True)
    assert isinstance(held.hold, PoseSettles) and held.hold.why == PoseJumped() and held.stop is None
    arm = watch.look(fix.look(now), JOINTS, tracks=False)
    assert arm.hold is None and arm.stop is None
    assert watch.may_drive(fix.look(now), JOINTS, [(0.0, 5.0, 0.0)], told=False) is not None
    assert watch.may_work(fix.look(now), [JOINTS, {"vessel_pin_joint": 0.5}]) is None


def test_an_arm_near_a_border_is_held_where_its_place_is_not_believed() -> None:
    watch, fix, now = guard(2.7)  # the hut is 0.3 m ahead
    assert watch.may_work(fix.look(now), [JOINTS]) is None
    fix.heard(now, 9.0, 0.0, 0.0)
    assert watch.look(fix.look(now), JOINTS, tracks=False).hold == PoseJumped()
    assert watch.may_work(fix.look(now), [JOINTS]) == PoseJumped()


def test_a_machine_that_drives_out_is_stopped() -> None:
    watch, fix, now = guard(16.0, 1.0)
    assert isinstance(watch.look(fix.look(now), JOINTS, tracks=True).stop, LeavesArea)


def test_a_goal_beside_a_hut_is_fine_unless_its_told_way_leads_through() -> None:
    watch, fix, now = guard(0.0)
    goal = (14.0, 0.0, 0.0)
    assert watch.may_drive(fix.look(now), JOINTS, [goal], told=False) is None
    assert isinstance(watch.may_drive(fix.look(now), JOINTS, [goal], told=True), EntersArea)


@pytest.mark.parametrize("told", [True, False])
def test_a_goal_is_refused_where_a_vague_pose_would_stop_it_on_the_way(told: bool) -> None:
    watch, fix, now = guard(0.0)
    goal = next(
        [(x, 10.0, 0.0)] for x in np.arange(19.0, 10.0, -0.02)
        if watch.law.arriving(watch.body(JOINTS), (x, 10.0, 0.0), fix.look(now).motion.off + 0.1) is None
    )  # fmt: skip
    there = [(0.0, 0.0, math.pi / 2), (0.0, 10.0, math.pi / 2), (0.0, 10.0, 0.0), *goal]
    assert watch.may_drive(fix.look(now), JOINTS, there, told) is None
    fix.heard(now, 0.0, 0.0, 0.0, 0.1)  # m
    assert isinstance(watch.may_drive(fix.look(now), JOINTS, there, told), LeavesArea)
