"""Every subtask of every model runs once on the stand-in, with its example record: loops over configs/."""

import json
from collections.abc import Iterator
from pathlib import Path

import pytest
import yaml

from conftest import NO_CONSOLE, PROJECT, Mesh, ports_of, running, site_data
from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse, read_yaml

pytestmark = [pytest.mark.system, pytest.mark.timeout(300)]
MODELS = sorted(path.stem for path in (CONFIGS / "machines").glob("*.yaml"))
SPEED = 25.0  # times real time
ELSEWHERE = {  # subtasks that need more than their machine
    "wait_for_ur": "a person: test_permission.py",
    **dict.fromkeys(
        ("choose_dig_point", "choose_dump_point", "dig_again_until", "wait_until_loaded"),
        "ground, excavator and truck: test_earthwork.py",
    ),
}
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
        f'<Action ID="LeafNode{model.capitalize()}" model_name="{machine}" subtask_name="{name}" '
        f'record_name="{record}"/>'
        for action in uses.subtasks
        if uses.subtask(action).run not in ELSEWHERE
        for name, record in (*before(uses, action), (action, uses.subtask(action).example))
    ]
    parts = ["".join(leaves[i : i + AT_ONCE]) for i in range(0, len(leaves), AT_ONCE)]
    return [
        f'<root main_tree_to_execute="T"><BehaviorTree ID="T"><Sequence>{part}</Sequence></BehaviorTree></root>'
        for part in parts
    ]


def before(uses: MachineModel, action: str) -> list[tuple[str, str]]:
    """What must be done first, as subtasks and records: a stored plan begins where the arm was when it was made."""
    if uses.subtask(action).run != "change_pose_execute_from_plan":
        return []
    known = [(name, uses.subtask(name)) for name in uses.subtasks]
    move = next(name for name, use in known if use.run == "change_pose" and not use.inputs["plan_only"])
    plan = next(name for name, use in known if use.run == "change_pose_plan")
    return [(move, "initial_pose"), (plan, uses.subtask(action).example)]


@pytest.fixture(params=MODELS)
def model(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture
def machine_mesh(model: str, own_domain: int, tmp_path: Path) -> Iterator[Mesh]:
    """A mesh with one machine of the model."""
    machines = {instance(model): {"model": model}}
    data = site_data(
        own_domain, ports_of(own_domain), name="every", machines=machines, sim={"speed": SPEED}, **NO_CONSOLE
    )
    (tmp_path / "site.yaml").write_text(yaml.safe_dump(data))
    with running(Mesh(tmp_path / "site.yaml", tmp_path / "state")) as mesh:
        yield mesh


@pytest.mark.turns
def test_every_subtask_runs_once(model: str, machine_mesh: Mesh, tmp_path: Path) -> None:
    machine_mesh.tms("param", "load", str(PROJECT / "configs" / "parameters" / f"{model}.yaml"))
    for number, tree in enumerate(trees(model, instance(model)), 1):
        (tmp_path / "tree.xml").write_text(tree)
        machine_mesh.tms("task", "add", str(tmp_path / "tree.xml"))
        done = machine_mesh.tms("run", str(number), "--wait", "--json", expect=None, limit=240)
        assert json.loads(done.stdout)["outcome"] == "success", done.stdout
