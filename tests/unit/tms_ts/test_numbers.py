"""Fencing numbers only grow."""

import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from tms_ts.numbers import Numbers


def test_they_grow_over_restarts_and_when_the_clock_goes_back(tmp_path: Path) -> None:
    first = Numbers(tmp_path).next()
    assert abs(first - time.time() * 1000) < 60_000
    (tmp_path / "ts" / "number").write_text(str(first + 10_000_000))
    assert Numbers(tmp_path).next() == first + 10_000_001
    (tmp_path / "ts" / "number").write_text("")
    assert Numbers(tmp_path).next() >= first


def test_runs_that_start_at_once_get_different_numbers(tmp_path: Path) -> None:
    numbers = Numbers(tmp_path)
    with ThreadPoolExecutor(20) as pool:
        given = list(pool.map(lambda _: numbers.next(), range(400)))
    assert len(set(given)) == len(given)
