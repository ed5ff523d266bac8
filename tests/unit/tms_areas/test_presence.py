"""Where a machine is among shared places, and where it may still come to be."""

from dataclasses import replace

import numpy as np

from areas.history import Outline
from areas.shared import TRACKS
from tms_areas.areas import Area, AreaSet
from tms_areas.fix import Motion, Seen
from tms_areas.law import Law
from tms_areas.reasons import PoseOld
from tms_areas.release import Presence

NONE: frozenset[str] = frozenset()
ROAD = Area("road", "release", ((10, -15), (16, -15), (16, 15), (10, 15)))
YARD = Area("yard", "unmanned", ((-40, -15), (60, -15), (60, 15), (-40, 15)))
LAW = Law(AreaSet((YARD, ROAD)), "m", TRACKS)
BODY = Outline(np.array([(-2.5, -1.5), (2.5, -1.5), (2.5, 1.5), (-2.5, 1.5)])).body(())


def look(there: Presence, now: float, motion: Motion | None, drives: bool = False, sure: bool = True) -> None:
    there.look(LAW, BODY, Seen(None if sure else PoseOld(1.0), motion), [ROAD], drives, now)


def test_a_machine_that_moves_is_near_what_it_may_roll_into() -> None:
    there, moving = Presence(), Motion(6.0, 0.0, 0.0, 2.0, age=0.1)
    for drives in (True, False):  # also after its goal
        look(there, 1.0, moving, drives)
        assert (there.inside, there.near) == (NONE, {"road"})
    look(there, 2.0, replace(moving, x=-20.0))
    assert there.near == NONE
    look(there, 3.0, replace(moving, x=-20.0, vx=-2.0))
    assert there.near == NONE


def test_who_is_seen_to_stand_is_near_only_when_nothing_may_come_of_its_goal_any_more() -> None:
    there, beside = Presence(), Motion(7.0, 0.0, 0.0)
    look(there, 10.0, beside)
    assert there.near == NONE, "it stood before"
    look(there, 20.0, beside, drives=True)
    look(there, 20.5, beside)
    assert there.near == {"road"} and there.inside == NONE
    look(there, 22.0, beside)
    assert there.near == NONE
    look(there, 23.0, Motion(8.0, 0.0, 0.0))
    assert there.near == there.inside == {"road"}


def test_an_old_pose_changes_nothing_of_where_it_was_last() -> None:
    there = Presence()
    look(there, 1.0, None, sure=False)
    assert there.near == there.inside == NONE
    look(there, 2.0, Motion(12.0, 0.0, 0.0))
    look(there, 3.0, Motion(0.0, 0.0, 0.0), sure=False)
    assert there.inside == {"road"} and there.near >= {"road"}
