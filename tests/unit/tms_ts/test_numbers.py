"""Fencing numbers only grow."""

import time
from pathlib import Path

from tms_ts.numbers import Numbers


def test_they_grow_over_restarts_and_when_the_clock_goes_back(tmp_path: Path) -> None:
    first = Numbers(tmp_path).next()
    assert abs(first - time.time() * 1000) < 60_000
    (tmp_path / "ts" / "number").write_text(str(first + 10_000_000))
    assert Numbers(tmp_path).next() == first + 10_000_001
    (tmp_path / "ts" / "number").write_text("")
    assert Numbers(tmp_path).next() >= first
