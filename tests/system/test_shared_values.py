"""Two runs at once that share flags: the writer and the reader of the field, and a swap that only one may win."""

import json
from pathlib import Path

import pytest

from conftest import CLI, Mesh, wait_until

pytestmark = [pytest.mark.turns, pytest.mark.system]
FIELD = Path(__file__).resolve().parents[1] / "data" / "field_tasks"
SWAP = (
    '<root main_tree_to_execute="T"><BehaviorTree ID="T"><Action ID="MongoValueSwap" mongo_record_name="ROAD" '
    'mongo_param_name="TAKEN" expected_value="false" input_value="true"/></BehaviorTree></root>'
)


def stored(mesh: Mesh, file: Path) -> str:
    return str(json.loads(mesh.tms("task", "add", str(file), "--json").stdout)["task_id"])


def state_of(mesh: Mesh, run: str) -> str:
    return next(row["state"] for row in json.loads(mesh.tms("runs", "--json").stdout) if row["run_id"] == run)


def test_writer_and_reader_of_the_field_as_two_runs(mesh: Mesh) -> None:
    mesh.tms("param", "set", "/sample_val", "VALUE1=0", "VALUE2=0", "VALUE3=0", "--create", "--type", "dynamic")
    runs = []
    try:
        for name in ("sample_reader.xml", "sample_writer.xml"):  # the order does not matter
            started = mesh.tms("run", stored(mesh, FIELD / name), "--json")
            runs.append(json.loads(started.stdout)["run_id"])

        def written() -> bool:
            values = json.loads(mesh.tms("param", "get", "/sample_val", "--json").stdout)["values"]
            return bool(values["VALUE1"] == 100 and values["VALUE2"] == 200 and values["VALUE3"] in (200, 300))

        wait_until(written, 60, "the writer's values")
        assert [state_of(mesh, run) for run in runs] == ["running", "running"]
        warnings = [row["text"] for row in json.loads(mesh.tms("events", runs[0], "--json").stdout)
                    if row["kind"] == "warning"]  # fmt: skip
        assert any("no active task and no sensing input writes VALUE1 of sample_val" in text for text in warnings)
    finally:
        for run in runs:
            mesh.tms("cancel", run, expect=None)
    for run in runs:
        wait_until(lambda: state_of(mesh, run) == "cancelled", 60, f"the end of {run}", every=CLI)  # noqa: B023


def test_a_lock_is_taken_once(mesh: Mesh, tmp_path: Path) -> None:
    mesh.tms("param", "set", "/ROAD", "TAKEN=false", "--create", "--type", "dynamic")
    (tmp_path / "swap.xml").write_text(SWAP)
    task = stored(mesh, tmp_path / "swap.xml")
    mesh.tms("run", task, "--wait")
    second = mesh.tms("run", task, "--wait", expect=1)
    assert "TAKEN is True, not False" in second.stderr + second.stdout
    refused = mesh.tms("param", "set", "/ROAD", "TAKEN=true", "--expect", "TAKEN=false", expect=1)
    assert "was not changed: TAKEN is True, not False" in refused.stderr
