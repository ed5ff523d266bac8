"""Two schedulers share a site by machine: each task is run by its own, and no machine by both."""

import json
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import pytest
import yaml

import programs
from conftest import CLI, PROJECT, Mesh, claimed_domain, ports_of, site_data, wait_until
from tms_config.config import load_site
from tms_config.processes import find
from tms_runtime.metrics import unready

pytestmark = pytest.mark.turns

DATA = PROJECT / "tests" / "data"
EAST = "tms:ts_east"
PCS = {
    "cps": {"address": "127.0.0.1", "roles": ["cps", "machine", "sensing", "sim"]},
    "east": {"address": "127.0.0.1", "roles": ["scheduler"], "machines": ["east_zx200"]},
}
MACHINES = {"zx200": {"model": "zx200"}, "east_zx200": {"model": "zx200", "start": [20.0, 0.0, 0.0]}}
LEAF = '<Action ID="LeafNodeZx200" model_name="{}" record_name="swing_left" subtask_name="subtask_zx200_change_pose"/>'
TREE = '<root main_tree_to_execute="M"><BehaviorTree ID="M"><Sequence>{}</Sequence></BehaviorTree></root>'
WRITE = '<Action ID="MongoValueWriter" input_value="true" mongo_record_name="MEETING" mongo_param_name="READY"/>'
WAIT = """<RetryUntilSuccessful num_attempts="-1"><Sequence>
  <Action ID="BlackboardValueReaderMongo" output_port="R" mongo_record_name="MEETING" mongo_param_name="READY"/>
  <Action ID="ConditionalExpression" conditional_expression="R == true"/>
</Sequence></RetryUntilSuccessful>"""
MINE, THEIRS, BOTH, WAITING = "1", "2", "3", "4"


@dataclass
class Cps(Mesh):
    """The main PC, and the scheduler of the other one, which is a process of its own here."""

    east: list[programs.Program] = field(default_factory=list)

    @property
    def env(self) -> dict[str, str]:
        return {**super().env, "TMS_PC": "cps"}

    def start_east(self) -> None:
        self.east.append(programs.process(EAST, self.environment_of("east"), self.state.with_name("east.log")))
        row = find(load_site(str(self.site)), EAST)
        wait_until(lambda: unready(row) is None, 30, lambda: self.state.with_name("east.log").read_text())

    def kill_east(self) -> None:
        self.east[-1].kill()
        self.east.pop().wait(10)

    def begin(self, task: str) -> str:
        return str(json.loads(self.tms("run", task, "--json").stdout)["run_id"])

    def state_of(self, run: str) -> str:
        rows = json.loads(self.tms("runs", "--json").stdout)
        return next(str(row["state"]) for row in rows if row["run_id"] == run)


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Cps]:
    """Tasks: long swings of zx200, of east_zx200, and one move of both."""
    folder = tmp_path_factory.mktemp("two")
    with claimed_domain() as domain:
        data = site_data(
            domain, ports_of(domain), pcs=PCS, machines=MACHINES, services={"db": {}, "ts": {}, "host": {}}
        )
        (folder / "site.yaml").write_text(yaml.safe_dump(data))
        made = Cps(folder / "site.yaml", folder / "cps")
        try:
            made.tms("up")
            made.start_east()
            made.arm()
            _prepare(made, folder)
            yield made
        finally:
            for one in made.east:
                one.kill()
                one.wait(10)
            made.tms("down", expect=None)


def _prepare(made: Cps, folder: Path) -> None:
    records, swings = (DATA / "swings.yaml").read_text(), (DATA / "many_swings.xml").read_text()
    (folder / "east.yaml").write_text(records.replace("model_name: zx200", "model_name: east_zx200"))
    made.tms("param", "load", str(DATA / "swings.yaml"))
    made.tms("param", "load", str(folder / "east.yaml"))
    (folder / "meeting.yaml").write_text("- {record_name: MEETING, type: dynamic, description: test, READY: false}\n")
    made.tms("param", "load", str(folder / "meeting.yaml"))
    theirs = swings.replace('model_name="zx200"', 'model_name="east_zx200"').replace("<Sequence>", f"<Sequence>{WRITE}")
    (folder / "east.xml").write_text(theirs)
    (folder / "waiting.xml").write_text(TREE.format(WAIT + LEAF.format("zx200")))
    (folder / "both.xml").write_text(TREE.format(LEAF.format("zx200") + LEAF.format("east_zx200")))
    for file in (DATA / "many_swings.xml", folder / "east.xml", folder / "both.xml", folder / "waiting.xml"):
        made.tms("task", "add", str(file))


def test_each_runs_the_tasks_of_its_machines_at_once(site: Cps) -> None:
    mine, theirs = site.begin(MINE), site.begin(THEIRS)
    assert theirs.endswith("-east") and not mine.endswith("-east")
    assert site.state_of(mine) == site.state_of(theirs) == "running"
    assert "is in run" in site.tms("run", BOTH, expect=1).stderr
    site.tms("cancel", theirs)
    assert "is in run" in site.tms("run", BOTH, expect=1).stderr
    site.tms("cancel", "last")
    assert site.state_of(mine) == site.state_of(theirs) == "cancelled"
    both = json.loads(site.tms("run", BOTH, "--wait", "--json").stdout)
    assert both["outcome"] == "success" and not both["run_id"].endswith("-east")


def test_a_machine_that_the_other_scheduler_has_is_not_to_be_had(site: Cps) -> None:
    theirs = site.begin(THEIRS)
    refused = site.tms("run", BOTH, expect=1).stderr
    assert f"east_zx200 is in run {theirs} of {EAST}" in refused
    site.tms("cancel", theirs)
    wait_until(lambda: site.tms("run", BOTH, "--wait", expect=None).returncode == 0, 30, "it was given back", every=CLI)


def test_what_a_run_of_the_other_scheduler_writes_may_be_waited_for(site: Cps) -> None:
    lonely = "no active task and no sensing input writes READY"
    checked = lambda: site.tms("task", "check", WAITING, expect=None).stdout  # noqa: E731
    wait_until(lambda: lonely in checked(), 30, "nobody writes it", every=CLI)
    theirs = site.begin(THEIRS)
    wait_until(lambda: lonely not in checked(), 30, "their run writes it", every=CLI)
    site.tms("cancel", theirs)


def test_without_its_scheduler_a_machine_is_the_main_ones_and_the_lost_run_is_resumed(site: Cps) -> None:
    lost = site.begin(THEIRS)
    site.kill_east()
    wait_until(lambda: site.tms("rearm", "east_zx200", "--yes", expect=None).returncode == 0, 30, "stopped", every=CLI)
    others: list[str] = []

    def taken() -> bool:
        done = site.tms("run", THEIRS, "--json", expect=None)
        others.extend([json.loads(done.stdout)["run_id"]] if done.returncode == 0 else [])
        return bool(others)

    wait_until(taken, 40, "the main scheduler takes it, once the lease is over", every=CLI)
    assert not others[0].endswith("-east")
    site.start_east()
    assert "is in run" in site.tms("resume", lost, "--yes", expect=1).stderr
    site.tms("cancel", others[0])
    wait_until(lambda: site.tms("resume", lost, "--yes", expect=None).returncode == 0, 30, "it is resumed", every=CLI)
    site.tms("cancel", lost)
