"""Every subtask of every model runs once on the stand-in, with its example record: loops over configs/."""

import json
from collections.abc import Iterator
from pathlib import Path

import pytest
import yaml

from conftest import PROJECT, Mesh, claimed_domain, ports_of, running, site_data
from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse, read_yaml

pytestmark = [pytest.mark.system, pytest.mark.timeout(300)]
MODELS = sorted(path.stem for path in (CONFIGS / "machines").glob("*.yaml"))
SPEED = 25.0  # times real time
FAR = 40.0  # m
AT_ONCE = 5  # subtasks a tree: each is a process, and all of a tree are started at once


def instance(model: str) -> str:
    """The machine whose records configs/parameters/<model>.yaml holds."""
    names = {record["model_name"] for record in read_yaml(CONFIGS / "parameters" / f"{model}.yaml")}
    assert len(names) == 1, f"{model}.yaml holds records of {names}"
    return str(names.pop())


def trees(model: str, machine: str) -> list[str]:
    """Trees that together hold one leaf for each subtask of the model."""
    uses = parse(CONFIGS / "machines" / f"{model}.yaml", MachineModel)
    leaves = [
        f'<Action ID="LeafNode{model.capitalize()}" model_name="{machine}" subtask_name="{action}" '
        f'record_name="{uses.subtask(action).example}"/>'
        for action in uses.subtasks
    ]
    parts = ["".join(leaves[i : i + AT_ONCE]) for i in range(0, len(leaves), AT_ONCE)]
    return [
        f'<root main_tree_to_execute="T"><BehaviorTree ID="T"><Sequence>{part}</Sequence></BehaviorTree></root>'
        for part in parts
    ]


@pytest.fixture(scope="module")
def yard(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Mesh]:
    """A mesh with one machine of every model, and their records."""
    folder = tmp_path_factory.mktemp("every")
    machines: dict[str, dict[str, object]] = {instance(model): {"model": model} for model in MODELS}
    for number, excavator in enumerate(("zx200", "zx120")):
        machines[excavator]["start"] = [0.0, FAR * (number + 1), 0.0]  # out of reach of all others
    with claimed_domain() as domain:
        data = site_data(domain, ports_of(domain), name="every", machines=machines, sim={"speed": SPEED})
        (folder / "site.yaml").write_text(yaml.safe_dump(data))
        with running(Mesh(folder / "site.yaml", folder / "state")) as mesh:
            for model in MODELS:
                mesh.tms("param", "load", str(PROJECT / "configs" / "parameters" / f"{model}.yaml"))
            yield mesh


@pytest.mark.parametrize("model", MODELS)
def test_every_subtask_runs_once(model: str, yard: Mesh, tmp_path: Path) -> None:
    for tree in trees(model, instance(model)):
        (tmp_path / "tree.xml").write_text(tree)
        added = json.loads(yard.tms("task", "add", str(tmp_path / "tree.xml"), "--json").stdout)
        done = yard.tms("run", str(added["task_id"]), "--wait", "--json", expect=None, limit=240)
        assert json.loads(done.stdout)["outcome"] == "success", done.stdout
