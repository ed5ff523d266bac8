"""The way back of a machine that stands outside: only further in, slowly, and into no other area."""

import math

import numpy as np
import pytest

from tms_areas.areas import Area, AreaSet
from tms_areas.body import Body, Part, Silhouette
from tms_areas.braking import Axis, Tracks
from tms_areas.escape import FASTER, GROWS, SPEED, Escape
from tms_areas.fix import Motion, Seen
from tms_areas.law import Law
from tms_areas.reach import Place
from tms_areas.reasons import ComesFurtherOut, EscapesTooFast, NotFurtherIn, PoseJumped, TracksNotSlow
from tms_reason.reason import Reason

TRACKS = Tracks(Axis(1.0, 0.5, 0.5), Axis(0.4, 0.4, 0.5))
YARD = Area("yard", "unmanned", ((-20, -20), (20, -20), (20, 20), (-20, 20)))
HUT = Area("hut", "manned", ((10, -10), (16, -10), (16, -3.2), (10, -3.2)))


class Reaching(Silhouette):
    """A square of 2 m whose arm reaches so far ahead as its joint says."""

    def __init__(self) -> None:
        self._whole = Part(np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]), math.sqrt(2))

    def body(self, joints: object) -> Body:
        (pose,) = joints  # type: ignore[misc]
        reach = pose["arm"]
        arm = Part(np.array([(0.0, -0.2), (reach, -0.2), (reach, 0.2), (0.0, 0.2)]), reach)
        return Body((self._whole, arm))


def escape(slow: bool = True) -> Escape:
    return Escape(Law(AreaSet((HUT, YARD)), "zx200", TRACKS, slow=slow), Reaching())


def at(x: float, y: float = 0.0, yaw: float = 0.0, v: float = 0.0, turning: float = 0.0) -> Seen:
    return Seen(None, Motion(x, y, yaw, v * math.cos(yaw), v * math.sin(yaw), turning))


def drive(seen: Seen, *way: Place, told: bool = True) -> Reason | None:
    return escape().may_drive(seen, {"arm": 1.0}, way, told)


def test_goals_lead_back_in_only() -> None:
    out = at(20.0)  # its front is a metre out
    assert drive(out, (17.0, 0.0, 0.0)) is None
    assert drive(out, (19.0, 0.0, 0.0)) is None  # not all of the way
    assert isinstance(drive(out, (21.0, 0.0, 0.0)), ComesFurtherOut)
    assert isinstance(drive(out, (20.0, 3.0, 0.0)), NotFurtherIn)
    assert isinstance(drive(out, (22.0, 0.0, 0.0), (15.0, 0.0, 0.0)), ComesFurtherOut)  # not first further out


def test_of_a_way_that_a_planner_chooses_only_the_places_count() -> None:
    assert drive(at(20.0), (17.0, 0.0, math.pi), told=False) is None
    assert isinstance(drive(at(20.0), (21.0, 0.0, 0.0), told=False), ComesFurtherOut)


def test_no_other_area_is_entered_on_the_way() -> None:
    assert drive(at(20.0, -2.0), (15.0, -2.0, 0.0)) is None
    assert isinstance(drive(at(20.0, -2.5), (13.0, -2.5, 0.0)), ComesFurtherOut)
    inside_the_hut = at(13.0, -4.0)
    assert drive(inside_the_hut, (13.0, 0.0, math.pi / 2), told=False) is None
    assert isinstance(drive(inside_the_hut, (13.0, -5.0, 0.0), told=False), ComesFurtherOut)


def test_a_machine_that_is_out_altogether_comes_nearer() -> None:
    assert drive(at(30.0), (27.0, 0.0, 0.0)) is None
    assert isinstance(drive(at(30.0), (30.0, 5.0, 0.0)), NotFurtherIn)


def test_the_arm_may_be_drawn_in_and_not_stretched() -> None:
    out = at(18.0)
    assert escape().may_work(out, [{"arm": 4.0}, {"arm": 1.0}]) is None
    assert isinstance(escape().may_work(out, [{"arm": 3.0}, {"arm": 4.0}]), ComesFurtherOut)
    assert isinstance(escape().may_work(out, [{"arm": 3.0}, {"arm": 4.0}, {"arm": 1.0}]), ComesFurtherOut)
    assert isinstance(escape().may_work(out, [{"arm": 3.0}, {"arm": 3.0}]), NotFurtherIn)


def test_it_is_stopped_that_comes_further_out_than_it_has_been() -> None:
    one, joints = escape(), {"arm": 1.0}
    for x in (20.0, 19.7, 19.4):
        assert one.look(at(x, v=-SPEED), joints, tracks=True).stop is None
    assert one.look(at(19.4 + GROWS - 0.01), joints, tracks=True).stop is None  # poses vary
    assert isinstance(one.look(at(19.4 + GROWS + 0.01), joints, tracks=True).stop, ComesFurtherOut)


def test_it_is_stopped_before_it_comes_further_out() -> None:
    assert isinstance(escape().look(at(20.0, v=SPEED), {"arm": 1.0}, tracks=True).stop, ComesFurtherOut)


def test_it_is_stopped_that_comes_into_another_area() -> None:
    one, joints = escape(), {"arm": 1.0}
    assert one.look(at(20.0, -1.0), joints, tracks=True).stop is None
    assert isinstance(one.look(at(15.5, -2.5), joints, tracks=True).stop, ComesFurtherOut)


@pytest.mark.parametrize(("v", "turning"), [(-SPEED * FASTER - 0.02, 0.0), (0.0, 0.4 * SPEED * FASTER + 0.02)])
def test_it_is_stopped_that_is_too_fast(v: float, turning: float) -> None:
    found = escape().look(at(30.0, v=v, turning=turning), {"arm": 1.0}, tracks=True).stop
    assert isinstance(found, EscapesTooFast)


def test_an_arm_that_stretches_is_stopped() -> None:
    one = escape()
    assert one.look(at(18.0), {"arm": 3.0}, tracks=False).stop is None
    assert isinstance(one.look(at(18.0), {"arm": 3.5}, tracks=False).stop, ComesFurtherOut)


def test_nothing_moves_while_its_place_is_not_believed() -> None:
    unsure, one, joints = Seen(PoseJumped(), Motion(20.0, 0.0, 0.0)), escape(), {"arm": 4.0}
    assert one.look(unsure, joints, tracks=False).hold == PoseJumped()
    assert one.may_drive(unsure, joints, [(17.0, 0.0, 0.0)], True) == PoseJumped()
    assert one.may_work(unsure, [joints, {"arm": 1.0}]) == PoseJumped()
    assert not one.over(unsure, joints)


def test_tracks_that_cannot_be_slowed_stay() -> None:
    assert escape(slow=False).may_drive(at(20.0), {"arm": 1.0}, [(17.0, 0.0, 0.0)], True) == TracksNotSlow("zx200")
    assert escape(slow=False).may_work(at(18.0), [{"arm": 4.0}, {"arm": 1.0}]) is None


def test_it_is_over_inside_with_the_margin() -> None:
    assert not escape().over(at(19.5), {"arm": 1.0})
    assert not escape().over(at(18.99), {"arm": 1.0})  # inside, and no room to stop
    assert escape().over(at(17.5), {"arm": 1.0})
    assert not escape().over(at(17.5), {"arm": 4.0})
