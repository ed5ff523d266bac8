"""Tasks of version 6 of the C++ system run on stand-ins to the end that their author meant, with our records.

`runs.jsonl` has what is expected of each: how it ends, and the goals that it sends, in order. An endless task is
cancelled after these. Two files give their templates not what they need, and are refused before anything moves.
"""

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml

from conftest import CLI, NO_CONSOLE, PROJECT, Mesh, claimed_domain, ports_of, running, site_data, wait_until
from v6_site import MACHINES, RECORDS, filled
from v6_templates import TASKS

pytestmark = [pytest.mark.turns, pytest.mark.system, pytest.mark.timeout(300)]
SPEED = 40.0  # times real time; the timers of the tasks keep to the wall clock
EXPECTED = [json.loads(line) for line in (TASKS / "runs.jsonl").read_text(encoding="utf-8").splitlines()]
SENT = re.compile(r"sent to (\S+), record (.*)")
APART = {"mst110cr_2": [28.5, 70.0, 0.0], "mst2200": [28.5, 90.0, 0.0]}  # m, m, rad: two of a model start at one place


@pytest.fixture(scope="module")
def yard(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Mesh]:
    """A mesh with the machines of the tasks, their records and templates."""
    folder = tmp_path_factory.mktemp("yard")
    machines: dict[str, dict[str, object]] = {name: {"model": model} for name, model in MACHINES.items()}
    for name, place in APART.items():
        machines[name]["start"] = place
    (folder / "given").mkdir()
    for file in TASKS.glob("subtask__*.xml"):
        (folder / "given" / f"{file.stem.rpartition('__')[2]}.xml").write_bytes(file.read_bytes())
    with claimed_domain() as number:
        data = site_data(number, ports_of(number), name="yard", machines=machines, sim={"speed": SPEED}, **NO_CONSOLE)
        (folder / "site.yaml").write_text(yaml.safe_dump(data))
        with running(Mesh(folder / "site.yaml", folder / "state")) as mesh:
            for name in RECORDS:
                mesh.tms("param", "load", str(PROJECT / "configs" / "parameters" / f"{name}.yaml"))
            mesh.tms("template", "add", str(PROJECT / "configs" / "templates"), str(folder / "given"))
            yield mesh


def goals(mesh: Mesh, run: str) -> list[list[str]]:
    """The goals that a run has sent, in order; one that a full PC had it send again, as its history tells, is one."""
    found, again = list[list[str]](), False
    for row in json.loads(mesh.tms("events", run, "--json").stdout):
        sent = SENT.match(row["text"]) if row["kind"] == "goal" else None
        if sent and not (again and found and found[-1] == [*sent.groups()]):
            found.append([*sent.groups()])
        again = row["kind"] in ("again", "loss") or (again and not sent)
    return found


@pytest.mark.parametrize("row", EXPECTED, ids=[row["file"].removesuffix(".xml") for row in EXPECTED])
def test_a_task_runs_to_its_end(yard: Mesh, row: dict[str, Any], tmp_path: Path) -> None:
    yard.tms("param", "load", str(PROJECT / "configs" / "parameters" / "version6.yaml"))  # flags as at the begin
    file = tmp_path / row["file"]
    file.write_text(filled(file.stem), encoding="utf-8")
    number = json.loads(yard.tms("task", "add", str(file), "--json").stdout)["task_id"]
    if row["outcome"] == "endless":
        run = json.loads(yard.tms("run", str(number), "--json").stdout)["run_id"]
        try:
            wait_until(lambda: len(goals(yard, run)) >= len(row["goals"]), 120, "a round and more", every=CLI)
        finally:
            yard.tms("cancel", run)
        assert goals(yard, run)[: len(row["goals"])] == row["goals"]
        return
    done = json.loads(yard.tms("run", str(number), "--wait", "--json", expect=None, limit=240).stdout)
    assert done["outcome"] == row["outcome"], done
    assert done["outcome"] == "refused" or goals(yard, done["run_id"]) == row["goals"]
