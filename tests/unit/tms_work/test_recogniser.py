"""An excavator's samples become cycles: each bucket counts once, whatever happens on its way."""

import json
from typing import Any

import pytest

from tms_work import sums
from tms_work.cycle import Cycle
from tms_work.recogniser import Recogniser
from tms_work.ways import EXCAVATOR
from work_rig import BEGIN, HEAPED, Tape, amount, bucket, taken


def excavator() -> Recogniser:
    return Recogniser("zx200", EXCAVATOR, HEAPED)


def seen(tape: Tape) -> list[Cycle]:
    return taken(excavator(), tape.samples)


def test_a_bucket_with_all_its_parts() -> None:
    tape = bucket(bucket(Tape(), 0.8), 0.6, truck="ic120_2")
    first, second = seen(tape)
    assert first.parts == pytest.approx({"dig": 5.0, "swing_loaded": 4.0, "dump": 2.0})
    assert second.parts == pytest.approx({"swing_back": 3.0, "dig": 5.0, "swing_loaded": 4.0, "dump": 2.0})
    assert (first.run_id, first.machine, first.number, second.number, first.kind) == ("r1", "zx200", 1, 2, "dig")
    assert (first.into, second.into, first.soil, first.measured) == ("ic120_1", "ic120_2", "earth", False)
    assert (first.mass, first.bank, first.loose) == pytest.approx(amount(0.8))
    assert (first.fill, second.fill) == pytest.approx((0.8 / HEAPED, 0.6 / HEAPED))
    assert first.begun_at.timestamp() == pytest.approx(BEGIN) and second.begun_at == first.ended_at
    assert (first.buckets, first.distance) == (0, 0.0)


def test_waiting_for_a_truck_and_standing_by_a_stop() -> None:
    tape = Tape().go(5, 0.8, cuts=True).go(4, swing=0.5).go(10, moves=False).go(7, stopped=True, moves=False)
    (one,) = seen(tape.go(1, moves=False).go(2, 0.0, under="ic120_1"))
    # A second between two motions is no waiting.
    expected = {"dig": 5.0, "swing_loaded": 4.0, "wait_for_truck": 10.0, "stopped": 7.0, "dump": 3.0}
    assert one.parts == pytest.approx(expected)


def test_digging_begins_when_the_edge_is_in_the_ground() -> None:
    (one,) = seen(Tape().go(3).go(2, cuts=True).go(5, 0.8, cuts=True).go(4, swing=0.5).go(2, 0.0))
    assert (one.parts["swing_back"], one.parts["dig"]) == pytest.approx((3.0, 7.0))


def test_standing_over_a_truck_is_no_waiting_for_it() -> None:
    tape = Tape().go(5, 0.8, cuts=True).go(4, swing=0.5).go(5, moves=False, under="ic120_1")
    (one,) = seen(tape.go(1.8, 0.1, under="ic120_1").go(0.2, 0.0))
    assert one.parts == pytest.approx({"dig": 5.0, "swing_loaded": 9.0, "dump": 2.0})


def test_a_truck_that_drives_off_at_the_last_moment() -> None:
    (one,) = seen(Tape().go(5, 0.8, cuts=True).go(4, swing=0.5, under="ic120_1").go(0.2, 0.0))
    assert one.into == "ic120_1"


def test_spilled_soil_was_not_moved() -> None:
    tape = Tape().go(5, 0.8, cuts=True).go(2, swing=0.5).go(0.4, 0.7, swing=0.5).go(2, swing=0.5)
    (one,) = seen(tape.go(2, 0.0, under="ic120_1"))
    assert one.loose == pytest.approx(0.7) and one.parts["swing_loaded"] == pytest.approx(4.4)


def test_what_was_lost_on_the_way_makes_no_cycle() -> None:
    tape = Tape().go(5, 0.1, cuts=True).go(2, swing=0.5)
    for left in (0.08, 0.07, 0.055, 0.045, 0.035, 0.03, 0.025, 0.019, 0.015, 0.0):
        tape.go(0.2, left, swing=0.5).go(1, swing=0.5)
    assert [one.loose for one in seen(bucket(tape, 0.8))] == pytest.approx([0.8])


def test_a_bucket_emptied_beside_the_truck() -> None:
    (one,) = seen(bucket(Tape(), 0.8, truck=""))
    assert (one.into, one.loose) == ("", pytest.approx(0.8))


def test_a_bucket_partly_beside_the_truck_goes_where_most_of_it_went() -> None:
    tape = Tape().go(5, 0.8, cuts=True).go(4, swing=0.5)
    (one,) = seen(tape.go(0.6, 0.5).go(1, 0.0, under="ic120_1"))
    assert (one.into, one.loose) == ("ic120_1", pytest.approx(0.8))


def test_an_aborted_dig_goes_on_as_one_dig() -> None:
    tape = Tape().go(5, 0.4, cuts=True).go(2, 0.0).go(2, swing=0.5)
    (one,) = seen(bucket(tape, 0.8))
    assert one.loose == pytest.approx(0.8) and one.parts["dig"] == pytest.approx(12.0)


def test_a_bucket_emptied_in_several_goes_counts_once() -> None:
    tape = Tape().go(5, 0.8, cuts=True).go(4, swing=0.5).go(1, 0.4, under="ic120_1").go(2, under="ic120_1")
    tape.go(1, 0.3, under="ic120_1").go(2, swing=0.5).go(1, 0.0, under="ic120_2").go(3, swing=0.5)
    (one,) = seen(bucket(tape, 0.6))[:-1]
    assert (one.loose, one.into) == (pytest.approx(0.8), "ic120_1")


def test_a_rest_that_sticks_belongs_to_the_next_bucket() -> None:
    tape = Tape().go(5, 0.8, cuts=True).go(4, swing=0.5).go(2, 0.05, under="ic120_1").go(3, swing=0.5)
    first, second = seen(bucket(tape, 0.7))
    assert (first.loose, second.loose) == (pytest.approx(0.75), pytest.approx(0.7))
    assert first.parts["swing_loaded"] == pytest.approx(4.0)


def test_digging_again_before_the_bucket_is_empty_ends_the_cycle() -> None:
    tape = Tape().go(5, 0.8, cuts=True).go(4, swing=0.5).go(1, 0.4).go(2, swing=0.5)
    first, second = seen(bucket(tape, 0.7))
    assert (first.loose, second.loose) == (pytest.approx(0.4), pytest.approx(0.7))
    assert second.begun_at == first.ended_at and "swing_back" not in second.parts


def test_dumping_onto_a_pile_that_the_edge_touches() -> None:
    (one,) = seen(Tape().go(5, 0.8, cuts=True).go(4, swing=0.5).go(2, 0.0, cuts=True))
    assert one.loose == pytest.approx(0.8) and one.parts["dump"] == pytest.approx(2.0)


def test_a_dig_that_fills_slowly_is_none_the_less_a_bucket() -> None:
    (one,) = seen(Tape().go(100, 0.3).go(4, swing=0.5).go(2, 0.0, under="ic120_1"))
    assert one.loose == pytest.approx(0.3)


def test_carrying_by_driving() -> None:
    (one,) = seen(Tape().go(5, 0.8, cuts=True).go(10, to=6.0).go(2, 0.0))
    assert (one.loose, one.distance) == (pytest.approx(0.8), pytest.approx(6.0, abs=0.3))
    assert one.parts["swing_loaded"] == pytest.approx(10 - 1.6)


def test_repeated_and_older_samples_change_nothing() -> None:
    samples = bucket(bucket(Tape(), 0.8), 0.6).samples
    noisy = [one for k in range(len(samples)) for one in (samples[k], samples[k], samples[max(0, k - 9)])]
    assert taken(excavator(), noisy) == taken(excavator(), samples)
    many = [one._replace(time=one.time + late) for one in samples for late in (0.0, 0.05, 0.1)]
    assert taken(excavator(), many) == taken(excavator(), samples)


def test_what_is_no_number_is_no_sample() -> None:
    samples = bucket(Tape(), 0.8).samples
    bad = [samples[0]._replace(time=float("nan")), samples[0]._replace(load=amount(float("inf")))]
    assert taken(excavator(), [*bad, *samples[:30], *bad, *samples[30:]]) == taken(excavator(), samples)


def test_a_bucket_emptied_in_a_silence() -> None:
    tape = Tape().go(5, 0.8, cuts=True).go(4, swing=0.5, under="ic120_1")
    end = tape.time
    tape.time += 3600
    tape.loose = 0.0
    (one,) = seen(tape.go(5, under="ic120_1"))
    assert (one.loose, one.into) == (pytest.approx(0.8), "ic120_1")
    assert one.ended_at.timestamp() == pytest.approx(end) and one.seconds < 10


def test_what_nobody_saw_is_in_no_part() -> None:
    """A silence while it carries is in its cycle; one in which it was emptied is in the next one."""
    tape = Tape().go(5, 0.8, cuts=True).go(2, swing=0.5)
    tape.time += 30
    tape.go(2, swing=0.5)
    tape.time += 20
    tape.loose = 0.0
    first, second = seen(bucket(tape.go(3, swing=-0.5), 0.6))
    assert (first.loose, second.loose) == pytest.approx((0.8, 0.6))
    assert (first.unseen, second.unseen) == pytest.approx((30.2, 20.2))
    assert second.parts["swing_back"] < 4.0, "the silence is no part of it"
    assert first.parts == pytest.approx({"dig": 5.0, "swing_loaded": 3.8})
    found = sums.total([first, second])
    assert found.unseen == pytest.approx(50.4) and found.digging < 30.0, "figures an hour are of what was seen"


def test_a_rest_after_a_silence_is_no_bucket() -> None:
    tape = Tape().go(5, 0.8, cuts=True).go(4, swing=0.5, under="ic120_1")
    tape.time += 60
    tape.loose = 0.05
    first, second = seen(bucket(tape.go(1, 0.0, under="ic120_1").go(3, swing=-0.5), 0.7))
    assert (first.loose, second.loose) == (pytest.approx(0.76), pytest.approx(0.7))


def test_a_load_that_is_back_after_a_restart_was_counted() -> None:
    tape = bucket(Tape(), 0.8)
    until = len(tape.samples)
    tape.time += 3
    tape.loose = 0.7
    tape.go(2, swing=0.5).go(1, 0.0, swing=0.5).go(1, swing=0.5)
    tape.go(100, 0.3).go(4, swing=0.5).go(2, 0.0)
    samples = bucket(tape, 0.6).samples
    before, after = excavator(), excavator()
    found = taken(before, samples[:until])
    after.restore(json.loads(json.dumps(before.state())))
    assert [one.loose for one in found + taken(after, samples[until:])] == pytest.approx([0.8, 0.3, 0.6])


def test_samples_that_come_seldom_count_each_bucket() -> None:
    """Machines that live fast, on a PC that has much to do."""
    tape = Tape()
    for _ in range(3):
        tape.go(6, 0.8, cuts=True).go(4, swing=0.5).go(3, 0.0, under="ic120_1").go(5, swing=-0.5)
    found = taken(excavator(), tape.samples[::7])  # 1.4 s
    assert [one.loose for one in found] == pytest.approx([0.8] * 3, abs=0.01)


def test_a_bucket_filled_and_emptied_in_silences_that_was_weighed() -> None:
    tape = Tape()
    tape.kept["measured"] = True
    tape.time += 600
    tape.loose = 0.8
    tape.go(2, swing=0.5)
    tape.time += 3
    (one,) = seen(tape.go(0.2, 0.0).go(2, swing=0.5))
    assert one.loose == pytest.approx(0.8) and one.measured


def test_a_bucket_carried_through_a_clock_that_goes_back() -> None:
    tape = Tape().go(5, 0.8, cuts=True).go(2, swing=0.5)
    tape.time -= 7200
    (one,) = seen(tape.go(4, swing=0.5).go(2, 0.0, under="ic120_1"))
    assert one.loose == pytest.approx(0.8) and one.seconds == pytest.approx(6.0, abs=0.3)


def test_a_run_that_ends_in_the_middle() -> None:
    tape = Tape().go(5, 0.8, cuts=True).go(4, swing=0.5)
    tape.kept["run"] = ""
    tape.go(30, moves=False)
    tape.kept["run"] = "r2"
    (one,) = seen(tape.go(1, swing=0.5).go(2, 0.0, under="ic120_1"))
    assert (one.run_id, one.number, one.loose) == ("r2", 1, pytest.approx(0.8)) and one.seconds < 4


def test_a_run_that_ends_while_the_bucket_empties() -> None:
    tape = Tape().go(5, 0.8, cuts=True).go(4, swing=0.5).go(1, 0.4, under="ic120_1")
    tape.kept["run"] = "r2"
    first, second = seen(tape.go(1, 0.0, under="ic120_1"))
    assert (first.run_id, second.run_id, second.number) == ("r1", "r2", 1)
    assert first.loose + second.loose == pytest.approx(0.8)


def test_a_run_that_goes_on_goes_on_with_its_numbers() -> None:
    tape = bucket(Tape(), 0.8)
    tape.kept["run"] = "r2"
    bucket(tape, 0.8)
    tape.kept["run"] = "r1"
    bucket(tape, 0.8)
    assert [(one.run_id, one.number) for one in seen(tape)] == [("r1", 1), ("r2", 1), ("r1", 2)]


def test_numbers_of_old_runs_are_forgotten(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tms_work.recogniser.RUNS", 2)
    one, tape = excavator(), Tape()
    for run in ("r1", "r2", "r3"):
        tape.kept["run"] = run
        bucket(tape, 0.8)
    taken(one, tape.samples)
    assert one.state()["numbers"] == {"r2": 1, "r3": 1}


def test_work_without_a_run_is_not_counted() -> None:
    tape = Tape()
    tape.kept["run"] = ""
    assert seen(bucket(tape, 0.8)) == []


def test_a_state_that_is_none_changes_nothing() -> None:
    samples = bucket(bucket(Tape(), 0.8), 0.6).samples
    one = excavator()
    found = taken(one, samples[:40])
    kept: dict[str, Any] = json.loads(json.dumps(one.state()))
    for bad in ({"draft": 1}, kept | {"colour": "red"}, None):
        with pytest.raises(ValueError):
            one.restore(bad)
    assert [*found, *taken(one, samples[40:])] == taken(excavator(), samples)
