"""What a long run calls growth, and what its kills explain."""

from __future__ import annotations

import time

from soak.growth import Sample, growth, table
from soak.kills import BACK, SEEN, Kills


def rows(*memory: float) -> list[Sample]:
    return [Sample(each, 20, 14) for each in memory]


def test_warming_up_and_noise_are_no_growth() -> None:
    assert growth({"tms:ts": rows(20, 30, 31, 30, 31, 32, 31, 32, 31)}) == []


def test_memory_that_grows_is_found() -> None:
    found = growth({"tms:ts": rows(20, 30, 32, 34, 36, 38, 40, 42, 44)})
    assert found == ["tms:ts: memory grew from 32.0 to 42.0, allowed are 36.0"]


def test_a_leaked_handle_a_run_is_found() -> None:
    leaking = [Sample(30, 20 + number, 14) for number in range(9)]
    assert growth({"tms:ts": leaking}) == ["tms:ts: handles grew from 22.0 to 27.0, allowed are 24.0"]


def test_a_kill_explains_what_follows_it_and_nothing_else() -> None:
    kills = Kills(None)  # type: ignore[arg-type]
    kills.done = [(100.0, "tms:ts")]
    assert kills.explain_new(100.0 + SEEN, "tms:ts") and kills.explain_late(100.0 + BACK)
    assert not kills.explain_new(101.0, "tms:db") and not kills.explain_new(99.0, "tms:ts")
    assert not kills.explain_late(101.0 + BACK) and not kills.explain_late(99.0)


def test_what_the_work_starts_anew_has_not_ended_by_itself() -> None:
    kills = Kills(None)  # type: ignore[arg-type]
    kills.restarted("tms:ground")
    assert kills.explain_new(time.time(), "tms:ground") and not kills.explain_new(time.time(), "tms:db")
    assert kills.count("tms:ground") == 0  # it was asked to end, and has kept what it held


def test_the_table_tells_what_each_process_held() -> None:
    head, line = table({"tms:ts": rows(20, 30, 32, 34, 36, 38, 40, 42, 44)}).splitlines()
    assert head.split() == ["process", "memory", "[MB]", "handles", "threads"]
    assert line.split() == ["tms:ts", *"32.0 -> 42.0 20 -> 20 14 -> 14".split()]
