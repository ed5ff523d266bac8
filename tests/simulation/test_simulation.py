"""The simulation of a site itself: it repeats, it finds what is wrong, and it tells it shortly."""

from collections.abc import Iterable, Iterator
from dataclasses import replace

import pytest

from simulation import host
from simulation.defences import put_out
from simulation.plan import Planned, Press, SecondGateway, Trapped, machines, plan
from simulation.scenes import planned
from simulation.schedule import Schedule, shorter
from tms_decision.gateway import motion, stops
from tms_proof.proof import NOTHING
from tms_proof.standstill import StandStill

SEEDS = range(7_000, 7_012)


def test_the_same_seed_gives_the_same_history() -> None:
    first, second = (Schedule(17).run() for _ in range(2))
    assert list(map(str, first.history)) == list(map(str, second.history))
    assert first.events == second.events > 300


def test_a_site_has_up_to_three_machines() -> None:
    assert {machines(seed) for seed in range(100)} == {1, 2, 3}


def test_a_plan_has_faults_and_people() -> None:
    for seed in SEEDS:
        assert len(plan(seed)) >= 5 and plan(seed) == plan(seed)


def test_a_few_schedules_hold_and_move_the_machine() -> None:
    results = [Schedule(seed).run() for seed in SEEDS]
    assert [result.violation for result in results if result.violation] == []
    assert sum(result.goals for result in results) > len(results)


@pytest.fixture
def believes(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """A gateway that takes every machine for standing."""
    monkeypatch.setattr(StandStill, "proven", lambda self, proof, now: True)
    yield


@pytest.mark.usefixtures("believes")
def test_a_false_receipt_is_found_and_made_shorter() -> None:
    found = next(result for result in (Schedule(seed).run() for seed in SEEDS) if result.violation)
    assert "truly moving" in found.violation
    assert len(shorter(found).plan) < len(found.plan)


def test_a_gateway_that_looks_at_no_permit_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(motion, "check_chain", lambda gateway, now: None)
    assert any("moves on" in Schedule(seed).run().violation for seed in (87, 130))


def test_what_was_found_and_mended_is_found_again_without_the_mending(monkeypatch: pytest.MonkeyPatch) -> None:
    """A goal had just ended, and a machine that went on and replayed its record was believed to stand."""
    expected = stops._expected
    without = lambda gateway, goal, over, now: expected(gateway, goal, over, now) if over == now else NOTHING  # noqa: E731
    assert Schedule(53).run().violation == ""
    monkeypatch.setattr(stops, "_expected", without)
    assert "truly moving" in Schedule(53).run().violation


def test_what_a_stranger_has_cancelled_is_still_on_its_way(monkeypatch: pytest.MonkeyPatch) -> None:
    """The stop came a moment after the cancel, and the machine replayed its record while it went on."""
    expected = stops._expected
    assert Schedule(110677).run().violation == ""
    monkeypatch.setattr(stops, "_expected", lambda *words: replace(expected(*words), to_come={}, behind={}))
    assert "truly moving" in Schedule(110677).run().violation


def test_a_press_that_a_second_gateway_took_along_is_handed_on(monkeypatch: pytest.MonkeyPatch) -> None:
    """It was there for a second, showed its latch, and ended; the right one had started meanwhile."""
    for other in ("the host agent's note of a press", "the scheduler's handing on of a press"):
        put_out(other, monkeypatch.setattr)  # which is enough by itself
    kept = [one for one in planned(557426936) if not isinstance(one.act, SecondGateway)]
    found = [*kept, Planned(12.566, 0, SecondGateway(1.45))]
    assert Schedule(557426936, found).run().violation == ""
    monkeypatch.setattr(host, "alone", lambda gateway, now: gateway.alive(now))
    assert "before a re-arm" in Schedule(557426936, found).run().violation


def test_who_has_seen_a_machines_past_only_cannot_know_of_its_levers() -> None:
    """The machine ended to replay its record 5 ms before the receipt: no sample of its present had come yet."""
    assert Schedule(20615519).run().violation == ""


def test_a_restarted_gateway_and_its_scheduler_that_are_lost_together_leave_the_run_to_the_next_gateway() -> None:
    """The first proven stop of the restarted one had taken the run from the disk, and no goal had left since."""
    assert Schedule(20408093).run().violation == ""


def test_a_run_whose_scheduler_was_killed_right_after_it_told_of_it_is_lost() -> None:
    """A restarted gateway had its message, and no report that it was asserted; the next run took the machine."""
    assert Schedule(20767120).run().violation == ""


def test_a_record_that_begins_after_a_gap_shows_no_expected_motion() -> None:
    """A machine fell mute, got a goal, and replayed the motion before it, which went the same way."""
    assert Schedule(20837444).run().violation == ""


@pytest.mark.parametrize("seed", [31292, 16912990, 2912419538, 1277639756])
def test_a_motion_that_no_source_has_shown_is_waited_for(seed: int) -> None:
    """A stranger cancelled it, and the machine went on and replayed its record of before, in which it stood.

    The gateway was a second one, on a PC that knows nothing of the machine; or the goal came before the first sample;
    or the record had the end of another motion, once and again.
    """
    assert Schedule(seed).run().violation == ""


def test_a_press_ends_no_doubt_that_the_stop_before_it_has() -> None:
    """A frozen gateway got the host agent's press while it proved a stop, and the machine replayed its record.

    It stops at once by its facts, but it went on for a while, and nobody had seen it move.
    """
    assert Schedule(21136676).run().violation == ""


def test_who_gives_a_machine_back_while_the_disk_stalls_is_answered_in_time() -> None:
    """The stop could not be proven, and its time began when the disk had answered."""
    assert Schedule(21300211).run().violation == ""


def test_the_end_of_the_last_motion_shows_no_effect_of_a_stop() -> None:
    """The next goal had just left, to a machine that stops at once by its facts, and goes on for a while."""
    assert Schedule(778600196).run().violation == ""


def test_a_machine_that_has_stopped_a_goal_is_watched_while_the_disk_stalls() -> None:
    """Its receipt waited for the disk, its goal for the receipt; meanwhile somebody moved it by its levers."""
    assert Schedule(20372777).run().violation == ""


def test_a_press_is_lost_with_all_who_could_have_heard_it() -> None:
    """Host agent and scheduler were dead already, and the gateway was killed before the disk had its latch."""
    assert Schedule(40298452).run().violation == ""


def test_a_short_stall_of_the_disk_does_not_end_a_longer_one() -> None:
    assert Schedule(30304008).run().violation == ""


def test_a_rearm_whose_answer_is_lost_is_one() -> None:
    """The disk had it, and the gateway was killed before it could answer."""
    assert Schedule(2869398733).run().violation == ""


def test_a_machine_that_was_armed_after_its_run_was_lost_is_no_orphan() -> None:
    """The run hung, its gateway latched, a person armed it, and then the scheduler was killed with the run."""
    assert Schedule(178243126).run().violation == ""


def test_a_subtask_that_nobody_knew_is_found_to_be_a_later_one() -> None:
    """The host agent was frozen before it had told of it, and the subtask was killed during its goal."""
    assert Schedule(1120741919).run().violation == ""


def test_a_press_outlives_a_gateway_and_its_host_agent(monkeypatch: pytest.MonkeyPatch) -> None:
    """The gateway was killed before the disk had its latch, and the host agent before it could tell the next one."""
    put_out("the scheduler's handing on of a press", monkeypatch.setattr)
    assert Schedule(20280771).run().violation == ""
    put_out("the host agent's note of a press", monkeypatch.setattr)
    assert "before a re-arm" in Schedule(20280771).run().violation


@pytest.mark.parametrize("seeds", [range(60), [588]], ids=["during a run", "between runs"])
def test_a_press_outlives_a_gateway_while_the_host_agent_is_away(
    monkeypatch: pytest.MonkeyPatch, seeds: Iterable[int]
) -> None:
    """The scheduler has heard it, and sees no latch."""

    def told() -> set[str]:
        return {Schedule(seed, planned(50033358)).run().violation for seed in seeds if machines(seed) == 2}

    assert told() == {""}
    put_out("the scheduler's handing on of a press", monkeypatch.setattr)
    assert any("before a re-arm" in violation for violation in told())


def test_a_press_is_not_forgotten_when_its_gateway_is_killed_before_the_disk_has_the_latch() -> None:
    """Found by `make model`: the latch was shown, so the host agent did not hand the press on."""
    pressed = [Planned(2.0, 0, Press(0.1)), Planned(2.001, 0, Trapped("Publish", "rc", 0.0, 0.8))]
    assert [Schedule(seed, pressed).run().violation for seed in range(8)] == [""] * 8
