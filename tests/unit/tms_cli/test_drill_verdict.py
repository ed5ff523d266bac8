"""How a receipt is compared with the true motion."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest

from tms_cli.drill.plan import NONE, RC, SUBTASK, TS, How, StopScenario, Trial
from tms_cli.drill.record import Goal, MotionSample, Receipt, ReportedState, TrialRecording, sample_of
from tms_cli.drill.verdict import GOES_ON, UNTOLD, Row, TrialFacts, judge
from tms_config.models import Still

HIT = 1000.0  # s since 1970
KILL = StopScenario(How.KILL, (RC,))
STILL = Still(velocity=0.01, linear=0.02, angular=0.01, seconds=0.2, origin="test")


def truth(*moving: tuple[float, float], until: float = 20.0) -> list[MotionSample]:
    """60 Hz from the hit on; moving between these moments, at ten times the limit and 0.1 rad/s."""
    found, angle = [], 0.0
    for number in range(int(until * 60)):
        at = number / 60
        moves = any(begin <= at < end for begin, end in moving)
        angle += 0.1 / 60 * moves
        joints = {"swing_joint": angle, "boom_joint": 0.0}
        found.append(MotionSample(HIT + at, 10.0 if moves else 0.0, joints, (angle, 0.0)))
    return found


def receipt(begun: float = 0.5, seconds: float = 2.0, confirmed: bool = True) -> Receipt:
    detail = "" if confirmed else "still moving"
    return Receipt(HIT + begun, seconds, confirmed, "test", detail, HIT + begun + seconds)


def facts(motion: list[MotionSample], *receipts: Receipt, latch: str = "", **changes: Any) -> TrialFacts:
    record = TrialRecording(
        motion, list(receipts), {b"1": Goal(HIT - 1.0)}, [ReportedState(HIT + 3.0, latch, "")], [HIT + 0.6]
    )
    trial = Trial("zx200", changes.pop("stop_kind", KILL), changes.pop("fault", NONE), 0.1, 0.5)
    found = TrialFacts(trial, "zx200", record, HIT, HIT, HIT, 4.0, 3.0, GOES_ON)
    return replace(found, **changes)


def wrong(row: Row) -> set[str]:
    names = ("unconfirmed", "unlatched", "ran_on", "disturbed", "false_receipt")
    return {name for name in names if getattr(row, name)}


def test_an_honest_stop_is_measured() -> None:
    row = judge(facts(truth((0.0, 2.0)), receipt()))
    assert wrong(row) == set() and row.confirmed and not row.void
    assert row.reported_s == pytest.approx(0.6)
    assert row.stood_s == pytest.approx(2.0, abs=0.03)
    assert (row.travel_joint, row.travel_rad) == ("swing_joint", pytest.approx(0.2, abs=0.01))
    assert row.travel_m == pytest.approx(0.2, abs=0.01)


def test_goals_whose_server_was_killed_end_before_the_next_run() -> None:
    record = TrialRecording(goals={b"1": Goal(HIT), b"2": Goal(HIT, HIT + 1.0)})
    record.close_goals(HIT + 5.0)
    assert [one.ended for one in record.goals.values()] == [HIT + 5.0, HIT + 1.0]


@pytest.mark.parametrize(("until", "stood"), [(6.2, 2.0), (7.0, 7.0)])
def test_a_jump_at_a_release_is_no_run_on_but_what_lasts_is(until: float, stood: float) -> None:
    found = facts(truth((0.0, 2.0), (6.0, until)), receipt(seconds=8.0))
    found.record.releases.append(HIT + 5.9)
    row = judge(found)
    assert row.stood_s == pytest.approx(stood, abs=0.03)


@pytest.mark.parametrize(
    ("motion", "text"),
    [
        ([(0.0, 2.39)], "s before it was said to stand"),
        ([(0.0, 2.0), (2.9, 3.0)], "s after it was said to stand"),
        ([(0.0, 2.0), (2.45, 3.0)], "s after it was said to stand"),
        ([(0.0, 9.0)], "s before it was said to stand"),
        ([(0.0, 2.0), (5.0, 20.0)], "left stand-still 2.50 s after the receipt"),
    ],
)
def test_a_confirmed_receipt_of_a_moving_machine_is_false(motion: list[tuple[float, float]], text: str) -> None:
    row = judge(facts(truth(*motion), receipt()))
    assert text in row.false_receipt


@pytest.mark.parametrize(
    ("back", "later", "told"),
    [
        (15.0, [], "left stand-still 2.50 s after the receipt"),
        (15.0, [receipt(16.0, 10.0, confirmed=False)], ""),
        (15.0, [receipt(19.0, 10.0, confirmed=False)], "left stand-still 2.50 s after the receipt"),
        (29.0, [], ""),  # the gateway has not had the time to tell
        (None, [], ""),  # counted as a process that did not come back
    ],
)
def test_a_motion_while_the_gateway_is_gone_is_told_by_the_next_one(
    back: float | None, later: list[Receipt], told: str
) -> None:
    row = judge(facts(truth((0.0, 2.0), (5.0, 40.0), until=40.0), receipt(), *later, back_s=back))
    assert row.false_receipt.startswith(told) if told else not row.false_receipt


def test_a_motion_is_told_at_once_while_the_gateway_is_there() -> None:
    motion, bystander = truth((0.0, 2.0), (5.0, 40.0), until=40.0), StopScenario(How.KILL, (TS,))
    late = receipt(16.0, 10.0, confirmed=False)
    assert "left stand-still" in judge(facts(motion, receipt(), late, back_s=15.0, stop_kind=bystander)).false_receipt


@pytest.mark.parametrize("motion", [[(0.0, 2.29)], [(0.0, 2.0), (9.5, 20.0)]])
def test_a_motion_outside_of_what_a_receipt_claims_is_not_its_lie(motion: list[tuple[float, float]]) -> None:
    assert judge(facts(truth(*motion), receipt())).false_receipt == ""


def test_a_new_goal_may_move_it_again() -> None:
    found = facts(truth((0.0, 2.0), (2.6, 20.0)), receipt())
    assert judge(found).false_receipt
    found.record.goals[b"2"] = Goal(HIT + 2.55)
    row = judge(found)
    assert wrong(row) == set() and row.stood_s == pytest.approx(2.0, abs=0.03)


def test_a_goal_does_not_excuse_what_moved_before_it() -> None:
    found = facts(truth((0.0, 3.0)), receipt())
    found.record.goals[b"2"] = Goal(HIT + 2.6)
    assert "before" in judge(found).false_receipt


def test_a_motion_that_is_told_by_a_second_receipt_is_no_lie() -> None:
    creeps = truth((0.0, 2.0), (5.0, 20.0))
    reported = judge(facts(creeps, receipt(), receipt(5.5, 10.0, confirmed=False), latch="left stand-still"))
    assert wrong(reported) == {"unconfirmed", "ran_on"}  # `ran_on` only where the machine should obey
    under_way = receipt(0.2, 10.0, confirmed=False)
    assert judge(facts(creeps, receipt(), under_way, latch="x")).false_receipt == ""
    over = receipt(0.2, 1.0, confirmed=False)
    assert judge(facts(creeps, receipt(), over, latch="x")).false_receipt
    assert judge(facts(creeps, receipt(), receipt(8.5, 10.0, confirmed=False), latch="x")).false_receipt  # too late


def test_a_motion_that_begins_with_the_receipt_must_be_told() -> None:
    drifts = truth((0.0, 2.0), (2.45, 20.0))
    assert judge(facts(drifts, receipt(), receipt(2.8, 10.0, confirmed=False), latch="x")).false_receipt == ""


def test_a_motion_that_a_new_goal_overtakes_at_once_cannot_be_told() -> None:
    found = facts(truth((0.0, 1.5), (2.49, 5.0)), receipt())
    for later, lies in ((0.05, False), (0.2, True)):
        found.record.goals[b"2"] = Goal(HIT + 2.5 + later)
        assert bool(judge(found).false_receipt) is lies


def test_a_machine_that_moves_on_is_not_in_order_where_it_coasts() -> None:
    motion, no = truth((0.0, 9.0)), receipt(seconds=10.0, confirmed=False)
    assert wrong(judge(facts(motion, no, latch="x"))) == {"unconfirmed", "ran_on"}
    assert wrong(judge(facts(motion, no, latch="x", fault="nan"))) == {"unconfirmed", "ran_on"}  # a mere lie
    assert wrong(judge(facts(motion, no, latch="x", fault="coast"))) == {"unconfirmed"}
    uncovered = StopScenario(How.POWER, covered=False, latches=True)
    assert wrong(judge(facts(motion, no, latch="x", stop_kind=uncovered))) == {"unconfirmed"}


def test_what_is_not_confirmed_must_be_latched() -> None:
    motion = truth((0.0, 2.0))
    assert wrong(judge(facts(motion, receipt(confirmed=False)))) == {"unconfirmed", "unlatched"}
    assert wrong(judge(facts(motion))) == {"unconfirmed", "unlatched"}  # no receipt at all
    assert judge(facts(motion)).last_state == "its last state came +3.00 s from the hit: nothing holds it"
    latching = StopScenario(How.KILL, (TS,), shared=True, latches=True)
    assert wrong(judge(facts(motion, receipt(), stop_kind=latching))) == {"unlatched"}
    assert wrong(judge(facts(motion, receipt(), stop_kind=latching, latch="tms:ts was lost"))) == set()


def test_a_motion_that_had_ended_by_itself_proves_nothing() -> None:
    found = facts(truth((0.0, 0.4)))
    found.record.goals[b"1"] = Goal(HIT - 5.0, HIT + 0.5, arrived=True)
    assert judge(found).void == "its motion ended by itself" and wrong(judge(found)) == set()
    found.record.goals[b"1"] = Goal(HIT - 5.0, HIT + 4.0, arrived=True)  # nobody stopped it
    assert judge(found).void == "" and wrong(judge(found)) == {"unconfirmed", "unlatched"}


def test_a_subtask_that_was_hit_after_its_goal_proves_nothing() -> None:
    """The feedback of the run had come late: by the hit, another subtask stood behind the motion."""
    subtask = StopScenario(How.KILL, (SUBTASK,))
    found = facts(truth((0.0, 6.0)), stop_kind=subtask, elsewhere="zx200:swing")
    assert judge(found).void == "its run had gone on to zx200:swing before the hit" and wrong(judge(found)) == set()
    valid = facts(truth((0.0, 6.0)), stop_kind=subtask)
    assert judge(valid).void == "" and wrong(judge(valid))
    stopped = facts(truth((0.0, 1.0)), receipt(), stop_kind=subtask, elsewhere="zx200:swing")
    assert judge(stopped).void == "" and wrong(judge(stopped)) == set()


def test_a_loss_while_no_goal_moves_the_machine_is_not_measured() -> None:
    """A planner that is killed while it plans: the stop that follows ends no motion, and nobody hurries."""
    found = facts(truth((0.0, 2.0)), receipt())
    assert judge(found).reported_s == pytest.approx(0.6)
    found.record.goals[b"1"] = Goal(HIT - 5.0, HIT - 0.1, arrived=True)
    assert judge(found).void == "" and judge(found).reported_s is None


def test_a_machine_that_was_stopped_before_proves_nothing() -> None:
    found = facts(truth((0.0, 0.4)), receipt())
    found.record.states.insert(0, ReportedState(HIT - 0.1, "joint states are silent", ""))
    assert judge(found).void == "it was stopped before: joint states are silent"
    found.record.states[0] = ReportedState(HIT - 0.1, "", "")
    assert judge(found).void == ""


def test_a_machine_that_stood_at_the_hit_proves_nothing() -> None:
    """On a busy PC a run may lose a process that nobody hit, and the hit may come late."""
    for fault, receipts in ((NONE, [receipt()]), ("nan", [])):
        found = facts(truth(), *receipts, fault=fault)
        found.record.goals[b"1"] = Goal(HIT - 6.0, HIT - 4.0)
        assert judge(found).void == "it was stopped before the hit"
        found.record.truth[:] = truth((0.5, 0.6))
        assert judge(found).void == ""  # it moved without a goal
    found = facts(truth(), receipt(-0.4), fault="nan", begun=HIT - 0.5)  # which has stopped it
    found.record.goals[b"1"] = Goal(HIT - 6.0, HIT - 0.1)
    assert judge(found).void == ""


def test_a_stop_that_was_under_way_at_the_hit_proves_nothing() -> None:
    """Of a process that a busy PC has lost: it still moved when it was hit, and its only receipt is of that stop."""
    found = facts(truth((0.0, 0.4)), receipt(-0.3, 0.9))
    found.record.goals[b"1"] = Goal(HIT - 5.0, HIT + 0.2)
    assert judge(found).void == "it was being stopped before"
    found.record.truth[:] = truth((0.0, 0.9))
    assert judge(found).false_receipt and not judge(found).void


def test_a_truth_with_a_gap_proves_nothing_but_a_lie() -> None:
    found = facts([one for one in truth((0.0, 9.0)) if not 3.0 < one.at - HIT < 5.0])
    assert judge(found).void == "its true motion was not received for 2.0 s" and not judge(found).ran_on
    found.record.truth[:] = [one for one in truth((0.0, 3.0)) if not 3.0 < one.at - HIT < 9.0]  # to beyond what it may
    assert judge(found).void == "its true motion was not received for 6.0 s" and not judge(found).ran_on
    found.record.truth[:] = [one for one in truth((0.0, 9.0)) if not 3.0 < one.at - HIT < 5.0]
    found.record.receipts.append(receipt())
    assert judge(found).false_receipt and not judge(found).void


def test_an_end_that_the_database_did_not_tell_proves_nothing_but_a_lie() -> None:
    assert judge(facts(truth((0.0, 2.0)), receipt(seconds=3.0), outcome=UNTOLD)).void.startswith("the database")
    lied = judge(facts(truth((0.0, 9.0)), receipt(), outcome=UNTOLD))
    assert lied.false_receipt and not lied.void


def test_a_goal_that_began_after_the_hit_was_stopped_too() -> None:
    found = facts(truth((0.3, 2.0)), receipt())
    found.record.goals[b"2"] = Goal(HIT + 0.2)
    assert judge(found).stood_s == pytest.approx(2.0, abs=0.03)


def test_a_lost_process_beside_the_motion_stops_nothing() -> None:
    beside = StopScenario(How.KILL, ("tms:db",), moves=False)
    found = facts(truth((0.0, 3.0)), receipt(1.2), stop_kind=beside, stop=HIT + 1.0)
    row = judge(found)
    assert wrong(row) == set() and row.reported_s is None and row.stood_s == pytest.approx(2.0, abs=0.03)
    assert wrong(judge(replace(found, record=facts(truth((0.0, 2.0)), receipt(0.7)).record))) == {"disturbed"}
    excused = judge(replace(found, record=facts(truth((0.0, 2.0)), receipt(0.7)).record, busy="this PC did not run it"))
    assert wrong(excused) == set() and excused.void == "this PC did not run it"
    assert judge(replace(found, busy="this PC did not run it")).void == ""


def test_the_truth_is_measured_against_the_limits_of_standing() -> None:
    message = SimpleNamespace(
        header=SimpleNamespace(stamp=SimpleNamespace(sec=1000, nanosec=500_000_000)),
        name=["swing_joint", "x", "y", "yaw"], position=[0.1, 1.0, 2.0, 0.3], velocity=[0.005, 0.03, 0.04, 0.0],
    )  # fmt: skip
    sample = sample_of(message, STILL)
    assert sample.at == 1000.5 and sample.place == (1.0, 2.0)
    assert sample.share == pytest.approx(2.5)  # the tracks, 0.05 m/s
    assert sample.joints == {"swing_joint": 0.1, "heading": 0.3}


def test_a_record_keeps_what_was_open() -> None:
    record = TrialRecording(
        truth((0.0, 1.0)), [receipt(-5.0), receipt(-1.0), receipt()],
        {b"old": Goal(HIT - 9.0, HIT - 5.0), b"open": Goal(HIT - 9.0), b"new": Goal(HIT + 1.0)},
        [ReportedState(HIT - 9.0, "a", ""), ReportedState(HIT - 5.0, "b", ""), ReportedState(HIT + 1.0, "c", "")],
        [HIT - 1.0, HIT + 1.0],
    )  # fmt: skip
    found = record.since(HIT)
    assert [one.begun for one in found.receipts] == [HIT - 1.0, HIT + 0.5]  # the first was under way
    assert set(found.goals) == {b"open", b"new"}
    assert [one.latch for one in found.states] == ["b", "c"] and found.commands == [HIT + 1.0]
    assert len(record.since(HIT + 6.0).truth) == pytest.approx(840, abs=1)
