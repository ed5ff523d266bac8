"""Records for readers of version 6, in both forms of their request."""

import asyncio
import json
from types import SimpleNamespace
from typing import Any

import pytest
import structlog
from tms_msg_if.srv import ReadRecords

from tms_if import reader_border
from tms_if.reader_border import ReaderBorder, path_of

PATH = {"x": [1.0, 2.0], "y": [0.0, 0.5], "z": [0.0, 0.0], "qx": [0, 0], "qy": [0, 0], "qz": [0, 0], "qw": [1, 1]}


class Told(SimpleNamespace):
    """A Tmsdb in their form."""

    plan: Any = None


def read(monkeypatch: pytest.MonkeyPatch, there: bool = True, **request: Any) -> tuple[list[Told], list[Any]]:
    """What a request gets of a database with one record, and what the database was asked."""
    monkeypatch.setattr(reader_border, "THEIRS", Told)
    asked: list[Any] = []

    async def call_async(_: Any, name: str, wanted: ReadRecords.Request, __: float) -> Any:
        asked.append((name, list(wanted.record_names), wanted.what))
        answer = ReadRecords.Response(found=["ROAD"], types=["static"], texts=[json.dumps(PATH)])
        return answer if there else None

    log = structlog.stdlib.get_logger("test")
    app: Any = SimpleNamespace(ros=SimpleNamespace(call_async=call_async), log=log)
    usual = {"type": "", "name": "", "recordnames": [], "param_type": ""}
    response = asyncio.run(
        ReaderBorder(app).records(SimpleNamespace(**{**usual, **request}), SimpleNamespace(tmsdbs=[]))
    )
    return response.tmsdbs, asked


def test_a_plan_is_a_path_in_the_map(monkeypatch: pytest.MonkeyPatch) -> None:
    (told,), asked = read(monkeypatch, type="parameter", name="ROAD", param_type="plan")
    assert asked == [("/tms/db/read_records", ["ROAD"], "param")]
    assert (told.name, told.type, json.loads(told.msg)) == ("ROAD", "static", PATH)
    assert [one.pose.position.x for one in told.plan.poses] == [1.0, 2.0] and told.plan.header.frame_id == "map"


@pytest.mark.parametrize("form", [{"param_type": "flg"}, {"param_type": "", "flgorparam": "flg"}])
def test_other_records_are_read_in_both_forms(monkeypatch: pytest.MonkeyPatch, form: dict[str, str]) -> None:
    (told,), asked = read(monkeypatch, recordnames=["ROAD", "no"], **form)
    assert asked == [("/tms/db/read_records", ["ROAD", "no"], "flg")] and told.plan is None


def test_what_is_not_there_is_empty(monkeypatch: pytest.MonkeyPatch) -> None:
    assert read(monkeypatch, name="ROAD", param_type="plan", there=False)[0] == []
    assert read(monkeypatch, name="ROAD", type="machine_pose") == ([], [])


@pytest.mark.parametrize(
    ("fields", "count"),
    [(PATH, 2), ({name: 1.0 for name in PATH}, 1), ({name: [] for name in PATH}, 0), ({**PATH, "x": "far"}, 0)],
)
def test_paths_of_records(fields: dict[str, Any], count: int) -> None:
    assert len(path_of(fields).poses) == count
