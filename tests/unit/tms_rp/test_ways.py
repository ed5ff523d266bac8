"""An excavator goes straight where it can, else around; it refuses only what it cannot reach."""

import json
import math
from itertools import pairwise

import numpy as np
import pytest

from conftest import PROJECT
from tms_config.config import CONFIGS
from tms_config.models import Box, MachineModel
from tms_config.yaml_file import parse
from tms_control.links import placed
from tms_control.reasons import PathBlocked
from tms_reason.errors import SubtaskFailed
from tms_reason.reason import Reason
from tms_rp.clearance import Clearance
from tms_rp.kind import Angles, Moves
from tms_rp.kinds import load
from tms_rp.kinds.backhoe.linkage import ArmAngles, Linkage
from tms_rp.messages import follow
from tms_rp.reasons import (
    Around,
    Collision,
    FoldSwingUnfold,
    Ground,
    LiftSwingLower,
    NoWayRound,
    OtherWayRound,
    PartOf,
    Searched,
    SlowlyOut,
)
from tms_rp.scene import Obstacle, Scene
from tms_rp.trajectory import Trajectory
from tms_rp.ways import Ways

MODEL = parse(CONFIGS / "machines" / "zx200.yaml", MachineModel)
TRUCK = parse(CONFIGS / "machines" / "ic120.yaml", MachineModel)
WAYS = Ways(MODEL, load("backhoe"))
LOW_RIGHT: Angles = (-1.571, -0.3, 1.4, 0.5)
LOW_LEFT: Angles = (1.571, *LOW_RIGHT[1:])
DIG_RIGHT: Angles = (-1.566, -0.228, 2.256, -0.618)  # a metre in the soil


def box(name: str, low: tuple[float, float, float], high: tuple[float, float, float]) -> Obstacle:
    return Obstacle(PartOf(name, "site"), Box(min=low, max=high), np.eye(4))


def truck(x: float, y: float) -> Scene:
    """An ic120 across the front, the middle of its vessel at (x, y)."""
    place = placed(x, y + 1.44, math.pi / 2)
    return Scene(tuple(Obstacle(PartOf(part, "ic120"), body, place) for part, body in TRUCK.footprint.items()))


WALL = box("wall", (4.0, -0.3, 0.0), (12.0, 0.3, 6.0))  # in front, higher than the boom lifts
ROOF = box("roof", (-12.0, -12.0, 6.46), (12.0, 12.0, 6.76))  # the boom hardly lifts below it
CRATE = box("crate", (4.5, -1.9, 0.0), (6.0, 0.6, 1.25))
UNDER_ROOF: tuple[Angles, Angles] = ((0.573, -0.419, 2.321, 2.164), (-1.86, -0.528, 2.18, -0.177))


def plan(scene: Scene, now: Angles, *targets: Angles) -> tuple[Trajectory, tuple[Reason, ...]]:
    found = WAYS.plan(now, Moves(targets), scene)
    return found.made, found.notes


def refusal(scene: Scene, now: Angles, *targets: Angles) -> Reason:
    with pytest.raises(SubtaskFailed) as caught:
        plan(scene, now, *targets)
    return caught.value.reason


def name_of(notes: tuple[Reason, ...]) -> Reason:
    (note,) = notes
    assert isinstance(note, Around) and note.why.find(Collision) is not None
    return note.way


def test_what_is_free_goes_straight_and_says_nothing() -> None:
    made, notes = plan(truck(20.0, 0.0), LOW_RIGHT, LOW_LEFT)
    assert notes == () and len(made.stops) == 1


def test_over_a_truck_it_lifts_swings_and_lowers() -> None:
    scene = truck(6.0, 0.0)
    made, notes = plan(scene, LOW_RIGHT, LOW_LEFT)
    assert name_of(notes) == LiftSwingLower()
    assert made.samples[-1].positions[:4] == pytest.approx(LOW_LEFT)
    Clearance(MODEL).check(made, scene.with_ground())


def test_before_a_wall_it_curls_in() -> None:
    scene = Scene((box("wall", (6.0, -0.3, 0.0), (12.0, 0.3, 12.0)),))
    assert name_of(plan(scene, LOW_RIGHT, LOW_LEFT)[1]) == FoldSwingUnfold()


def test_what_cannot_be_passed_in_front_is_passed_behind_and_the_rest_of_the_goal_follows() -> None:
    scene = Scene((box("wall", (2.5, -0.3, 0.0), (12.0, 0.3, 12.0)),))
    further = (1.2, *LOW_LEFT[1:])
    made, notes = plan(scene, LOW_RIGHT, LOW_LEFT, further)
    assert isinstance(name_of(notes), OtherWayRound)
    assert made.samples[-1].positions[0] == pytest.approx(further[0] - math.tau)
    assert max(sample.positions[0] for sample in made.samples) <= LOW_RIGHT[0] + 1e-9


def test_under_a_roof_it_searches_and_finds_the_same_way_again() -> None:
    scene = Scene((ROOF, CRATE))
    made, notes = plan(scene, *UNDER_ROOF)
    assert name_of(notes) == Searched()
    Clearance(MODEL).check(made, scene.with_ground())
    assert plan(scene, *UNDER_ROOF)[0] == made


def test_a_target_that_is_not_free_names_what_it_touches_and_not_what_is_on_the_way() -> None:
    said = refusal(Scene((WALL, box("pile", (-1.0, 5.0, 0.0), (1.0, 12.0, 3.0)))), LOW_RIGHT, LOW_LEFT)
    assert isinstance(said, Collision) and said.second == PartOf("pile", "site")


def test_a_target_in_a_truck_is_refused_with_what_where_and_how_deep() -> None:
    said = refusal(truck(6.0, 0.0), LOW_RIGHT, (0.0, *LOW_RIGHT[1:]))
    assert isinstance(said, Collision)
    assert isinstance(said.second, PartOf) and said.second.machine == "ic120"
    assert said.depth > 0.5 and 4.5 < said.x < 7.6 and -4.0 < said.y < 3.0 and said.z < 4.0


def test_without_a_way_it_says_what_is_in_the_way() -> None:
    scene = Scene(
        (box("front", (2.5, -0.3, 0.0), (12.0, 0.3, 12.0)), box("back", (-12.0, -0.3, 0.0), (-2.5, 0.3, 12.0)))
    )
    said = refusal(scene, LOW_RIGHT, LOW_LEFT)
    assert isinstance(said, NoWayRound) and said.find(PartOf) is not None


def test_out_of_the_soil_and_into_it_again_but_not_through_it() -> None:
    """A straight swing would plough; a way around touches the ground at its two ends alone."""
    dig_left: Angles = (-DIG_RIGHT[0], *DIG_RIGHT[1:])
    made, notes = plan(truck(6.0, 0.0), DIG_RIGHT, dig_left)
    assert notes
    linkage = Linkage.of(MODEL.geometry)
    heights = [linkage.tip(ArmAngles(*sample.positions[:4])).z for sample in made.samples]
    above = [height > 0 for height in heights]
    assert not above[0] and not above[-1]
    assert sum(a != b for a, b in pairwise(above)) == 2


def test_the_ground_is_no_obstacle_to_a_straight_motion() -> None:
    deeper = (*DIG_RIGHT[:3], DIG_RIGHT[3] + 0.4)
    assert plan(Scene(), DIG_RIGHT, deeper)[1] == ()
    high = (DIG_RIGHT[0], -0.9, *DIG_RIGHT[2:])
    with pytest.raises(SubtaskFailed) as caught:
        Clearance(MODEL).check(plan(Scene(), high, DIG_RIGHT, high)[0], Scene().with_ground())
    assert caught.value.reason.find(Ground) is not None


def test_the_bucket_never_opens_further_than_at_both_ends() -> None:
    for scene, now, target in (
        (truck(6.0, 0.0), LOW_RIGHT, LOW_LEFT),
        (Scene((WALL,)), LOW_RIGHT, LOW_LEFT),
        (Scene((ROOF, CRATE)), *UNDER_ROOF),
    ):
        made, notes = plan(scene, now, target)
        assert notes and min(sample.positions[3] for sample in made.samples) >= min(now[3], target[3]) - 1e-6


def test_out_of_something_it_moves_slowly_and_says_why() -> None:
    inside, beside = truck(6.0, 0.0), truck(20.0, 0.0)
    front: Angles = (0.0, *LOW_RIGHT[1:])
    slow, fast = (WAYS.plan(front, Moves((LOW_RIGHT,)), scene) for scene in (inside, beside))
    said = next(note for note in slow.notes if note.find(SlowlyOut) is not None)
    assert said.find(PartOf) is not None and fast.notes == ()
    assert fastest(slow.made) <= 0.25 * MODEL.joints["swing_joint"].velocity < fastest(fast.made)
    stuck = refusal(inside, front, (0.1, *LOW_RIGHT[1:]))
    assert stuck.find(Collision) is not None


def fastest(made: Trajectory) -> float:
    return max(abs(sample.velocities[0]) for sample in made.samples)


def test_what_comes_into_the_way_blocks_it_before_it_is_reached_and_not_behind() -> None:
    made, _ = plan(Scene(), LOW_RIGHT, (1.5, *LOW_RIGHT[1:]))
    assert WAYS.blocked(made, 0.0, truck(20.0, 0.0)) is None
    come = truck(6.0, 0.0)
    reached = refusal(come, LOW_RIGHT, (0.0, *LOW_RIGHT[1:])).find(Collision)
    assert reached is not None
    for seconds, found in ((0.0, True), (reached.seconds, True), (made.duration, False)):
        said = WAYS.blocked(made, seconds, come)
        assert (said is not None and said.find(PathBlocked) is not None) == found, seconds
    late = Scene((box("late", (-1.0, 7.5, 0.0), (1.0, 9.0, 3.0)),))
    assert WAYS.blocked(made, 0.0, late) is None  # there is time to stop later
    assert WAYS.blocked(made, 2.0, late) is not None


def test_what_drives_into_the_arm_blocks_it_too() -> None:
    made, _ = plan(Scene(), LOW_RIGHT, (1.5, *LOW_RIGHT[1:]))
    at = next(sample for sample in made.samples if sample.positions[0] >= 0)
    assert WAYS.blocked(made, at.time, truck(6.0, 0.0)) is not None


def test_a_place_that_is_told_some_centimetres_nearer_blocks_nothing() -> None:
    scene = truck(6.0, 0.0)
    made, _ = plan(scene, LOW_RIGHT, (1.5, *LOW_RIGHT[1:]))
    nearer = Scene(tuple(Obstacle(one.name, one.box, one.place.copy())
                         for one in scene.obstacles))  # fmt: skip
    for one in nearer.obstacles:
        one.place[2, 3] += 0.08
    assert all(WAYS.blocked(made, seconds, nearer) is None for seconds in np.arange(0.0, made.duration, 0.5))


@pytest.mark.parametrize("number", [66, 68, 86, 90])
def test_a_searched_way_keeps_above_the_ground_and_the_soil_in_the_bucket(number: int) -> None:
    """Recorded scenes in which a search without these two bounds breaks them."""
    recorded = json.loads(
        (PROJECT / "tests/data/planning_scenes.jsonl").read_text(encoding="utf-8").splitlines()[number]
    )
    scene = Scene(
        tuple(
            Obstacle(PartOf(one["name"], "site"), Box(min=one["min"], max=one["max"]), placed(*one["place"]))
            for one in recorded["obstacles"]
        )
    )
    now, target = tuple(recorded["now"]), tuple(recorded["target"])
    made, notes = plan(scene, now, target)
    assert name_of(notes) == Searched()
    Clearance(MODEL).check(made, scene.with_ground())
    assert min(sample.positions[3] for sample in made.samples) >= min(now[3], target[3]) - 1e-6


def test_plans_stop_between_them_where_the_rounded_way_is_not_free(monkeypatch: pytest.MonkeyPatch) -> None:
    plans = tuple(follow(plan(Scene(), a, b)[0]).trajectory for a, b in ((LOW_RIGHT, LOW_LEFT), (LOW_LEFT, LOW_RIGHT)))
    flowing = WAYS.plan(LOW_RIGHT, Moves((), plans=plans), Scene()).made
    check, refused = Clearance.check, list[Trajectory]()

    def refuse_once(self: Clearance, made: Trajectory, scene: Scene) -> None:
        if not refused:
            refused.append(made)
            raise SubtaskFailed(Ground())
        check(self, made, scene)

    monkeypatch.setattr(Clearance, "check", refuse_once)
    stopping = WAYS.plan(LOW_RIGHT, Moves((), plans=plans), Scene()).made
    assert refused == [flowing] and stopping.duration > flowing.duration
    assert any(not any(sample.velocities) for sample in stopping.samples[1:-1])
