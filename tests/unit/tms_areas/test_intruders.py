"""People among machines: who is where, how old that is, and what follows."""

import pytest
from pydantic import ValidationError

from tms_areas.areas import Area, AreaSet, Kind, Point
from tms_areas.intruders import Danger, Intruders
from tms_areas.reasons import (
    APerson,
    AVehicle,
    GateOpened,
    IntruderInside,
    IntruderNear,
    PlaceNoNumber,
    TrackerOfNoArea,
    TrackerSilent,
    TrackersNeedAreas,
    TrackerUnheard,
    TrackerUnreadable,
)
from tms_areas.trackers import SPEED, Tracker, trackers_flaw
from tms_areas.zones import Zones

CAMERA = Tracker(kind="person", topic="camera")
CARS = Tracker(kind="vehicle", topic="cars")
GATE = Tracker(kind="gate", topic="gate", type="std_msgs/msg/Bool", areas=("east",))
WEST, EAST = (-10.0, 0.0), (30.0, 0.0)  # a machine in each of two yards


def square(name: str, kind: Kind, x: float, y: float, half: float) -> Area:
    return Area(name, kind, ((x - half, y - half), (x + half, y - half), (x + half, y + half), (x - half, y + half)))


ZONES = Zones(
    AreaSet(
        (
            square("west", "unmanned", -10, 0, 10), square("more", "unmanned", -10, -15, 6),  # they overlap
            square("east", "unmanned", 30, 0, 10), square("hut", "manned", -15, 5, 2),
            square("fence", "restricted", 8, 0, 8), square("far", "restricted", 100, 0, 2),
        )
    )
)  # fmt: skip


def look(site: Intruders, now: float = 0.0, here: Point | None = WEST) -> Danger:
    return site.look(now, ZONES, "ic120", here)


def seen(*places: Point, tracker: Tracker = CAMERA) -> Intruders:
    site = Intruders({"eye": tracker}, 0.0)
    site.seen("eye", 0.0, places)
    return site


def test_nobody_seen_is_no_danger() -> None:
    assert look(seen()) == Danger()


def test_a_person_stops_the_machines_of_the_area_and_no_others() -> None:
    site = seen((-5.0, 3.0))
    assert look(site).stop == IntruderInside("ic120", APerson(), "west", "eye", -5.0, 3.0)
    assert look(site, here=EAST) == Danger()


def test_areas_between_which_machines_drive_are_one() -> None:
    assert look(seen((-10.0, -20.0))).stop == IntruderInside("ic120", APerson(), "more", "eye", -10.0, -20.0)


def test_who_is_not_known_to_be_elsewhere_stops_a_machine_without_a_place() -> None:
    assert look(seen((-5.0, 3.0)), here=None).stop is not None
    assert look(seen((-5.0, 3.0)), here=(500.0, 0.0)).stop is not None


@pytest.mark.parametrize(("x", "y"), [(-15.0, 5.0), (50.0, 50.0), (100.0, 0.0)])
def test_people_may_be_in_manned_areas_and_elsewhere(x: float, y: float) -> None:
    assert look(seen((x, y))) == Danger()


def test_a_person_in_the_restricted_area_warns_both_sides_of_it() -> None:
    site = seen((8.0, 0.0))
    assert (
        look(site)
        == look(site, here=(-1.0, 0.0))
        == Danger(warn=IntruderNear("ic120", APerson(), "fence", "eye", 8.0, 0.0))
    )


def test_a_vehicle_counts_with_its_size() -> None:
    beside = (-10.0, 12.0)  # 2 m beside the area
    assert look(seen(beside)) == Danger()
    found = look(seen(beside, tracker=CARS)).stop
    assert isinstance(found, IntruderInside) and found.who == AVehicle()
    assert look(seen(beside, tracker=Tracker(kind="vehicle", topic="cars", radius=1.5))) == Danger()


def test_old_news_reach_further() -> None:
    site, gap = seen((-10.0, 11.5)), 1.5 - 0.5  # m beside the area, less the radius of a person
    assert look(site, 0.9 * gap / SPEED["person"]) == Danger()
    assert look(site, 0.99).stop is not None


def test_a_silent_tracker_counts_as_somebody_inside() -> None:
    site = seen()
    assert look(site, 0.99) == Danger()
    assert look(site, 1.5).stop == TrackerSilent("eye", 1.5)
    site.seen("eye", 1.4, ())
    assert look(site, 1.5) == Danger()


@pytest.mark.parametrize("then", ["hold", "warn"])
def test_silence_may_mean_less_where_the_site_says_so(then: str) -> None:
    site = seen(tracker=Tracker.model_validate({"kind": "person", "topic": "tag", "on_silence": then}))
    assert look(site, 2.0) == Danger(**{then: TrackerSilent("eye", 2.0)})


def test_nothing_moves_before_a_tracker_was_heard() -> None:
    site = Intruders({"eye": CAMERA}, 0.0)
    assert look(site, 0.5) == Danger(hold=TrackerUnheard("eye"))
    assert look(site, 1.5).stop == TrackerSilent("eye", 1.5)


def test_a_tracker_that_watches_other_areas_does_not_count() -> None:
    given = Tracker(kind="person", topic="camera", areas=("east",))
    assert look(seen((-5.0, 3.0), tracker=given), 5.0) == Danger()
    assert look(seen(tracker=given), 5.0, EAST).stop is not None


def test_what_cannot_be_read_counts_as_silence_at_once() -> None:
    site = seen()
    site.unreadable("eye", PlaceNoNumber())
    assert look(site).stop == TrackerUnreadable("eye", PlaceNoNumber())
    site.seen("eye", 0.1, ())
    assert look(site, 0.1) == Danger()


def test_a_message_that_was_overtaken_is_no_news() -> None:
    site = seen()
    site.seen("eye", 0.5, ((-5.0, 3.0),))
    site.seen("eye", 0.4, ())
    assert look(site, 0.5).stop is not None


def test_a_gate_that_was_open_counts_until_a_person_has_looked() -> None:
    site = Intruders({"gate": GATE}, 0.0)
    site.gate("gate", 0.0, False)
    assert look(site, here=EAST) == Danger()
    site.gate("gate", 0.1, True)
    opened = GateOpened("ic120", "gate", ("east",))
    assert look(site, 0.1, EAST) == Danger(stop=opened, passed=opened) and look(site, 0.1, WEST) == Danger()
    site.gate("gate", 0.2, False)
    assert look(site, 0.2, EAST) == Danger(passed=opened)
    site.looked()
    assert look(site, 0.2, EAST) == Danger()
    site.gate("gate", 0.3, True)
    site.looked()
    assert look(site, 0.3, EAST).stop == opened  # it still is
    site.gate("gate", 0.4, True)
    assert site.openings == 2


def test_that_a_gate_was_open_counts_also_when_the_gate_is_silent_since() -> None:
    site = Intruders({"gate": GATE}, 0.0)
    site.gate("gate", 0.0, True)
    site.gate("gate", 0.1, False)
    found = look(site, 5.0, EAST)
    assert isinstance(found.stop, TrackerSilent) and isinstance(found.passed, GateOpened)


def test_a_gate_to_an_area_that_is_not_enabled_counts_everywhere() -> None:
    lost = Tracker(kind="gate", topic="gate", type="std_msgs/msg/Bool", areas=("south",))
    site = Intruders({"gate": lost}, 0.0)
    site.gate("gate", 0.0, True)
    assert look(site).stop is not None and look(site, here=EAST).stop is not None


def test_trackers_that_do_not_fit_the_areas_are_told() -> None:
    assert trackers_flaw({}, ()) is None and trackers_flaw({"gate": GATE, "eye": CAMERA}, ("east", "west")) is None
    assert trackers_flaw({"eye": CAMERA}, ()) == TrackersNeedAreas(("eye",))
    assert trackers_flaw({"gate": GATE}, ("west",)) == TrackerOfNoArea("gate", "east", ("west",))


@pytest.mark.parametrize(
    "wrong", [{"kind": "gate"}, {"kind": "gate", "type": "std_msgs/msg/Bool"}, {"type": "std_msgs/msg/Bool"}]
)
def test_settings_that_make_no_sense_are_refused(wrong: dict[str, str]) -> None:
    with pytest.raises(ValidationError):
        Tracker.model_validate({"kind": "person", "topic": "camera", **wrong})
