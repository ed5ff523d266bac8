"""Two schedulers share a site by machine: each task is run by its own, and no machine by both."""

import json
import os
import signal
import urllib.request
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
import yaml

from conftest import CLI, PROJECT, Mesh, claimed_domain, ports_of, site_data, wait_until
from tms_config.config import load_site
from tms_config.processes import find

pytestmark = pytest.mark.turns

DATA = PROJECT / "tests" / "data"
PCS = {
    "cps": {"address": "127.0.0.1", "roles": ["cps", "machine", "sim"]},
    "east": {"address": "127.0.0.2", "roles": ["scheduler"], "machines": ["east_zx200"]},
}
MACHINES = {"zx200": {"model": "zx200"}, "east_zx200": {"model": "zx200"}}
BOTH = (
    '<root main_tree_to_execute="M"><BehaviorTree ID="M"><Sequence>'
    '<Action ID="LeafNodeZx200" model_name="zx200" record_name="SWING_LEFT" subtask_name="subtask_zx200_swing"/>'
    '<Action ID="LeafNodeZx200" model_name="east_zx200" record_name="SWING_LEFT" subtask_name="subtask_zx200_swing"/>'
    "</Sequence></BehaviorTree></root>"
)


@dataclass
class Pc(Mesh):
    """One PC of the site."""

    name: str

    @property
    def env(self) -> dict[str, str]:
        return {**super().env, "TMS_PC": self.name}

    def row(self, process: str) -> tuple[str, int]:
        with pytest.MonkeyPatch.context() as patch:
            for key, value in self.env.items():
                patch.setenv(key, value)
            row = find(load_site(), process)
        return row.address, row.port

    def runs(self, process: str) -> float:
        """Runs that a scheduler has ended."""
        address, port = self.row(process)
        with urllib.request.urlopen(f"http://{address}:{port}/metrics", timeout=5) as answer:
            lines = answer.read().decode().splitlines()
        return sum(float(line.split()[-1]) for line in lines if line.startswith("tms_ts_runs_total"))

    def pid(self, process: str) -> int:
        rows = json.loads(self.tms("ps", "--json").stdout)
        return next(int(row["pid"]) for row in rows if row["name"] == process)

    def active(self) -> list[str]:
        rows = json.loads(self.tms("runs", "--json").stdout)
        return [row["run_id"] for row in rows if row["state"] == "running"]


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Pc, Pc]]:
    """The main PC, and the one with the second scheduler; tasks: 1 swings of zx200, 2 of east_zx200, 3 of both."""
    folder = tmp_path_factory.mktemp("two")
    file = folder / "site.yaml"
    with claimed_domain() as domain:
        data = site_data(domain, ports_of(domain), pcs=PCS, machines=MACHINES)
        file.write_text(yaml.safe_dump(data))
        cps, east = Pc(file, folder / "cps", "cps"), Pc(file, folder / "east", "east")
        try:
            cps.tms("up")
            east.tms("up")
            cps.arm()
            _prepare(cps, folder)
            yield cps, east
        finally:
            east.tms("down", expect=None)
            cps.tms("down", expect=None)


def _prepare(cps: Pc, folder: Path) -> None:
    records = (DATA / "swings.yaml").read_text()
    (folder / "east.yaml").write_text(records.replace("zx200", "east_zx200"))
    cps.tms("param", "load", str(DATA / "swings.yaml"))
    cps.tms("param", "load", str(folder / "east.yaml"))
    swings = (DATA / "many_swings.xml").read_text()
    (folder / "east.xml").write_text(swings.replace('"zx200"', '"east_zx200"'))
    (folder / "both.xml").write_text(BOTH)
    for path in (DATA / "many_swings.xml", folder / "east.xml", folder / "both.xml"):
        cps.tms("task", "add", str(path))


def begin(pc: Pc, task: int) -> str:
    return str(json.loads(pc.tms("run", str(task), "--json").stdout)["run_id"])


def test_each_runs_the_tasks_of_its_machines(site: tuple[Pc, Pc]) -> None:
    cps, east = site
    mine, theirs = begin(cps, 1), begin(cps, 2)
    refused = cps.tms("run", "3", expect=1)
    assert "is in run" in refused.stderr
    for run in (theirs, mine):
        assert "cancelled" in east.tms("cancel", run).stdout
    assert (cps.runs("tms:ts"), east.runs("tms:ts_east")) == (2.0, 1.0)


def test_a_task_of_both_is_the_main_ones_and_has_both_machines(site: tuple[Pc, Pc]) -> None:
    cps, east = site
    run = begin(east, 3)
    assert "is in run" in cps.tms("run", "2", expect=1).stderr
    cps.tms("cancel", run, expect=None)


def test_without_its_scheduler_a_machine_is_the_main_ones(site: tuple[Pc, Pc]) -> None:
    cps, east = site
    run = begin(cps, 2)
    os.kill(east.pid("tms:ts_east"), signal.SIGSTOP)
    east.tms("stop", "tms:ts_east")
    cps.tms("rearm", "east_zx200", "--yes", expect=None)
    again = begin(cps, 2)
    assert again != run and again in cps.active()
    east.tms("start", "tms:ts_east")
    wait_until(lambda: "cancelled" in cps.tms("cancel", again, expect=None).stdout, 30, "the cancel", every=CLI)
    assert "is interrupted" not in cps.tms("abandon", run).stderr
