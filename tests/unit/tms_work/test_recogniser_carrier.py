"""A carrier's samples become loads: buckets, way and times, tipped once."""

from collections.abc import Sequence

import pytest

from tms_work.cycle import Cycle
from tms_work.recogniser import Recogniser
from tms_work.ways import CARRIER
from work_rig import Tape, amount, taken

HEAPED = 5.9  # m3
LOADS = (0.7, 1.4, 2.1)  # m3 after each bucket


def seen(tape: Tape) -> list[Cycle]:
    return taken(Recogniser("ic120_1", CARRIER, HEAPED), tape.samples)


def load(tape: Tape, loads: Sequence[float] = LOADS) -> Tape:
    for loose in loads:
        tape.go(2, loose, moves=False).go(18, moves=False)
    return tape


def trip(tape: Tape) -> Tape:
    """Loaded at 0 m, tipped at 60 m, and back."""
    return load(tape).go(30, to=60.0).go(4).go(6, 0.0).go(4).go(30, to=0.0)


def test_a_load_with_all_its_parts() -> None:
    first, second = seen(trip(trip(Tape())))
    # It leaves the place where it was loaded when it is a metre away.
    assert first.parts == pytest.approx({"load": 60.4, "haul": 33.6, "tip": 6.0}, abs=0.01)
    assert second.parts == pytest.approx({"return": 34.0, "load": 60.4, "haul": 33.6, "tip": 6.0}, abs=0.01)
    assert (first.kind, first.number, first.buckets, second.number, second.buckets) == ("haul", 1, 3, 2, 3)
    assert (first.mass, first.bank, first.loose) == pytest.approx(amount(2.1))
    assert (first.distance, second.distance, first.fill) == pytest.approx((60.0, 120.0, 2.1 / HEAPED), abs=0.2)
    assert (first.into, first.soil) == ("", "earth")


def test_waiting_before_the_load_and_before_the_tip() -> None:
    tape = load(Tape().go(20, moves=False)).go(30, to=60.0).go(8, moves=False).go(1).go(5, stopped=True)
    (one,) = seen(tape.go(6, 0.0))
    assert (one.parts["wait"], one.parts["stopped"]) == pytest.approx((28.0, 5.0))
    assert one.parts["load"] == pytest.approx(60.4)


def test_moving_up_between_buckets_is_loading() -> None:
    tape = load(load(Tape()).go(5, to=1.5), (2.8, 3.5))
    (one,) = seen(tape.go(30, to=60.0).go(6, 0.0))
    assert (one.buckets, one.loose) == (5, pytest.approx(3.5)) and one.parts["load"] == pytest.approx(104.0, abs=2.0)


def test_a_bucket_that_falls_in_by_and_by_is_one() -> None:
    tape = Tape().go(1, 0.4).go(2).go(1, 0.5).go(3).go(1, 0.7).go(15)
    (one,) = seen(tape.go(30, to=60.0).go(6, 0.0))
    assert one.buckets == 1


def test_tipping_in_several_goes_while_it_creeps_on() -> None:
    tape = load(Tape()).go(30, to=60.0).go(2, 1.5).go(5).go(3, 0.7, to=61.0).go(5, to=63.0).go(3, 0.0, to=64.0)
    (one,) = seen(tape.go(30, to=0.0))
    assert one.loose == pytest.approx(2.1)


def test_a_pause_while_it_creeps_on_is_tipping() -> None:
    (one,) = seen(load(Tape()).go(30, to=60.0).go(3, 1.0, to=63.0).go(2).go(3, 0.0))
    assert one.parts["tip"] == pytest.approx(8.0)


def test_what_sticks_in_the_vessel_is_tipped_with_the_next_load() -> None:
    tape = load(Tape()).go(30, to=60.0).go(6, 0.1).go(30, to=0.0)
    first, second = seen(load(tape).go(30, to=60.0).go(6, 0.0))
    assert (first.loose, second.loose, second.buckets) == (pytest.approx(2.0), pytest.approx(2.1), 3)
    assert second.parts["return"] == pytest.approx(30.0, abs=0.5)


def test_soil_that_falls_off_on_the_way_is_not_hauled() -> None:
    tape = load(Tape()).go(30, to=60.0).go(1, 1.9).go(10, to=80.0)
    (one,) = seen(tape.go(6, 0.0))
    assert one.loose == pytest.approx(1.9)


def test_a_load_tipped_where_it_was_loaded() -> None:
    (one,) = seen(load(Tape()).go(6, 0.0))
    assert (one.loose, one.distance) == (pytest.approx(2.1), 0.0)


def test_a_pose_that_jumps_or_trembles_is_no_way() -> None:
    tape = load(Tape()).go(0.2, to=500.0).go(30, to=560.0)
    for k in range(50):
        tape.go(0.2, to=560.0 + 0.05 * (k % 2), moves=False)
    (one,) = seen(tape.go(6, 0.0))
    assert one.distance == pytest.approx(60.0, abs=0.3)
