"""The official tasks 1 to 11 and the two-machine demo run to SUCCESS; task 11 does with its machine name put right."""

import json
from collections.abc import Iterator
from pathlib import Path

import pytest
import yaml

from conftest import NO_CONSOLE, PROJECT, Mesh, claimed_domain, ports_of, running, site_data

pytestmark = [pytest.mark.turns, pytest.mark.system, pytest.mark.timeout(300)]
TASKS = PROJECT / "configs" / "tasks"
OFFICIAL = sorted((PROJECT / "tests" / "data" / "field_tasks").glob("task_id*.xml"), key=lambda path: path.name)
WIDE = "＿"  # the full-width underscore in a machine's name of task 11
MACHINES = {"zx200": "zx200", "zx120": "zx120", "ic120": "ic120", "d37pxi_24": "d37pxi"}
SPEED = 40.0  # times real time
# Official task 7 leaves the truck where an excavator that comes to dig would touch it.
ASIDE = """<root main_tree_to_execute="Aside"><BehaviorTree ID="Aside">
  <Action ID="LeafNodeIc120" model_name="ic120" record_name="dumping_place" subtask_name="st_ic120_navigate_anywhere"/>
</BehaviorTree></root>"""


@pytest.fixture(scope="module")
def yard(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Mesh]:
    """A mesh with the machines of the official tasks and all records."""
    folder = tmp_path_factory.mktemp("yard")
    machines: dict[str, dict[str, object]] = {name: {"model": model} for name, model in MACHINES.items()}
    machines["zx120"]["start"] = [-14.31, 15.0, 0.0]  # its place in SimpleScene is in reach of a zx200 that has turned
    with claimed_domain() as number:
        data = site_data(number, ports_of(number), name="yard", machines=machines, sim={"speed": SPEED}, **NO_CONSOLE)
        (folder / "site.yaml").write_text(yaml.safe_dump(data))
        with running(Mesh(folder / "site.yaml", folder / "state")) as mesh:
            for name in ("shared", *MACHINES.values()):
                mesh.tms("param", "load", str(PROJECT / "configs" / "parameters" / f"{name}.yaml"))
            yield mesh


def outcome(mesh: Mesh, file: Path) -> dict[str, str]:
    number = json.loads(mesh.tms("task", "add", str(file), "--json").stdout)["task_id"]
    done = mesh.tms("run", str(number), "--wait", "--json", expect=None, limit=240)
    answer: dict[str, str] = json.loads(done.stdout)
    return answer


@pytest.mark.parametrize("file", OFFICIAL, ids=lambda path: path.stem)
def test_official_task(yard: Mesh, file: Path) -> None:
    text = file.read_text(encoding="utf-8")
    if WIDE in text:
        answer = outcome(yard, file)
        assert answer["outcome"] == "refused" and WIDE in answer["error_msg"]
        file = TASKS / "d37pxi_drive.xml"
        assert file.read_text(encoding="utf-8") == text.replace(WIDE, "")
    answer = outcome(yard, file)
    assert answer["outcome"] == "success", answer


def test_an_excavator_and_a_truck_wait_for_each_other(yard: Mesh, tmp_path: Path) -> None:
    aside = tmp_path / "aside.xml"
    aside.write_text(ASIDE)
    assert outcome(yard, aside)["outcome"] == "success"
    answer = outcome(yard, TASKS / "zx200_and_ic120_load_and_haul.xml")
    assert answer["outcome"] == "success", answer
    rows = json.loads(yard.tms("events", answer["run_id"], "--json").stdout)
    texts = [row["text"] for row in rows if row["kind"] == "goal" and row["text"].startswith("sent")]
    over, away, back = (
        [i for i, text in enumerate(texts) if name in text]
        for name in ("load_over_vessel_pose", "dumping_place", "loading_place")
    )
    assert [back[0] < over[0] < away[0], back[1] < over[1] < away[1]] == [True, True]
