"""The API asks the database for recordings, and gives them by column."""

from types import SimpleNamespace
from typing import Any

import pytest
from builtin_interfaces.msg import Time
from tms_msg_db.msg import RecordedSeries
from tms_msg_db.srv import ReadRecording

from tms_reason.errors import RosError
from tms_ur.recording_client import LAST_SECOND, Asked, recording


def site(asked: list[ReadRecording.Request], **answer: Any) -> Any:
    def call(_: Any, service: str, request: ReadRecording.Request, limit: float) -> ReadRecording.Response:
        asked.append(request)
        return ReadRecording.Response(**answer)

    return SimpleNamespace(call=call)


def test_rows_become_columns() -> None:
    told = RecordedSeries(
        machine="zx200",
        kind="joints",
        names=["swing", "boom"],
        times=[1e9, 1e9 + 0.1],
        values=[0.123456, 1, 0.2, 2],
    )
    asked: list[ReadRecording.Request] = []
    (series,) = recording(site(asked, series=[told]), Asked("r-1", points=7)).series
    assert (series.times, series.values) == ([1e9, 1e9 + 0.1], [[0.1235, 0.2], [1.0, 2.0]])
    assert (asked[0].run_id, asked[0].points, asked[0].begin, asked[0].end) == ("r-1", 7, Time(), Time())


def test_a_time_is_asked_for() -> None:
    asked: list[ReadRecording.Request] = []
    recording(site(asked), Asked(begin=1.5, end=LAST_SECOND))
    assert (asked[0].begin, asked[0].end) == (Time(sec=1, nanosec=500_000_000), Time(sec=2**31 - 1))


def test_a_refusal_is_an_error() -> None:
    with pytest.raises(RosError) as refused:
        recording(site([], error_code="RUN_MISSING", error_msg='RUN_MISSING run="r"'), Asked("r"))
    assert refused.value.code == "RUN_MISSING"
