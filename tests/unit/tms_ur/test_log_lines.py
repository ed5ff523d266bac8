"""Lines of logs as our processes write them, merged by their times."""

import logging
from datetime import datetime, timedelta, timezone
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tms_config.clock import utc_now
from tms_runtime.log import formatter
from tms_ur.log_lines import Span, merged, parsed

JAPAN = timezone(timedelta(hours=9))


def at(second: float) -> datetime:
    return datetime(2026, 1, 31, 6, tzinfo=timezone.utc) + timedelta(seconds=second)


def line(second: float, text: str = "event=begun", level: str = "INFO") -> str:
    return f"{at(second).replace(tzinfo=None).isoformat(timespec='microseconds')} {level} {text}\n"


def found(text: str) -> list[tuple[float, str, str]]:
    return [((one.time - at(0)).total_seconds(), one.level, one.text) for one in parsed("p:q", text, timezone.utc)]


def test_a_line_has_time_level_and_text() -> None:
    assert found(line(1.5, "process=p:q run=r-1", "WARNING")) == [(1.5, "WARNING", "run=r-1")]
    (one,) = parsed("p:q", "2026-01-31T15:00:00.000000 INFO event=begun", JAPAN)
    assert (one.time, one.process) == (at(0), "p:q")


def test_a_line_without_a_time_belongs_to_the_one_before() -> None:
    text = "half a line\n" + line(1, "event=late", "ERROR") + "Traceback\n\n" + line(2)
    assert found(text) == [(1, "ERROR", "event=late"), (1, "ERROR", "Traceback"), (2, "INFO", "event=begun")]


@pytest.mark.parametrize(
    "text", ["", "no time", "2026-13-31T06:00:00.000000 INFO event=x", '{"time": 3}', "{", '{"time": "now"}']
)
def test_what_has_no_time_is_left_out(text: str) -> None:
    assert found(text) == []


@pytest.mark.parametrize("as_json", [False, True])
def test_lines_of_our_own_formatter(as_json: bool) -> None:
    record = logging.LogRecord("x", logging.ERROR, "", 0, "gateway_lost", (), None)
    written = formatter({"process": "zx200:rc"}, as_json).format(record)
    (one,) = parsed("zx200:rc", written)
    assert abs((one.time - utc_now()).total_seconds()) < 60
    assert (one.level, one.text) == ("ERROR", "event=gateway_lost")


def mixed(most: int, span: Span | None = None, **logs: str) -> tuple[list[str], bool]:
    lines = {name: parsed(name, text, timezone.utc) for name, text in logs.items()}
    result = merged(lines, span or Span(), most)
    return [f"{one.process} {one.text}" for one in result.lines], result.cut


def test_lines_of_all_processes_in_order_of_time_and_the_newest_of_many() -> None:
    logs: dict[str, Any] = {"a": line(1, "1") + line(3, "3"), "b": line(2, "2") + line(4, "4")}
    assert mixed(4, **logs) == (["a 1", "b 2", "a 3", "b 4"], False)
    assert mixed(3, **logs) == (["b 2", "a 3", "b 4"], True)
    assert mixed(9, Span(at(2), at(3)), **logs) == (["b 2", "a 3"], False)
    assert mixed(9, a=line(3, "3") + line(1, "1")) == (["a 1", "a 3"], False), "a clock was set back"


@given(st.text())
def test_any_text_is_read(text: str) -> None:
    assert all(one.time.tzinfo is not None for one in parsed("p:q", line(0) + text, timezone.utc))
