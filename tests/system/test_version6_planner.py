"""Excavators beside version 6: its primitives call our planner, and its planner plans for our primitives."""

import json
from collections.abc import Iterator
from pathlib import Path

import pytest

from conftest import NO_CONSOLE, Mesh, mesh_apart, running, wait_until
from upstream_peers import ABORTED, SUCCEEDED, ask, foreign_server

pytestmark = [pytest.mark.turns, pytest.mark.system]
FORM = "plans"
SITE = {
    "machines": {
        name: {"model": "zx200", "start": [0.0, 40.0 * row, 0.0]} for row, name in enumerate(("zx200", "zx200_2"))
    },
    "peers": {"zx200": {"leaf": "v6b", "motions": True}, "zx200_2": {"leaf": "v5", "planner": "theirs"}},
    "forms": {"TmsRpExcavator": FORM, "TmsdbGetData": "both"},
}
LEAF = (
    '<Action ID="LeafNodeExcavator" model_name="zx200_2" primitive_name="primitive_excavator_change_pose_{}" '
    'target_record_name="{}" previous_target_record_name="{}"/>'
)
TREE = '<root main_tree_to_execute="T"><BehaviorTree ID="T"><Sequence>{}</Sequence></BehaviorTree></root>'
LIMIT = 30.0  # s


@pytest.fixture(scope="module")
def mesh(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Mesh]:
    with mesh_apart(tmp_path_factory.mktemp("planner"), **NO_CONSOLE, **SITE) as made, running(made):
        yield made


def test_their_primitive_plans_and_moves_with_our_planner(mesh: Mesh) -> None:
    planned, executed = SUCCEEDED + " 1", SUCCEEDED + " 1 -0.5 0.3"
    words = ask(mesh, "excavator", "zx200", "boom_joint", "-0.5", "swing_joint", "0.3", form=FORM)
    assert " ".join(words) == f"{planned} {executed}"


def test_their_reader_gets_the_path_of_a_record(mesh: Mesh) -> None:
    lists = {"x": [1.0, 2.5], "qw": [1.0, 1.0], **{name: [0.0, 0.0] for name in ("y", "z", "qx", "qy", "qz")}}
    mesh.tms(
        "param", "set", "zx200/ROAD", *(f"{name}={json.dumps(value)}" for name, value in lists.items()), "--create"
    )
    for service in ("tms_db_reader", "tms_db_param_reader"):
        assert ask(mesh, "plan", service, "ROAD", form="both") == ["1", "1.0", "2.5"]  # one server


def test_their_planner_plans_for_our_primitives(mesh: Mesh, tmp_path: Path) -> None:
    """What it plans rests in records, and moves the machine through our planner and gateway."""
    for name, kind, data in (("A", "absolute", {"swing_joint": 0.4}), ("B", "relative", {"boom_joint": 0.2})):
        waypoints = [{"type": f"joint_values_{kind}", "data": data}]
        values = {"planning_group": json.dumps("arm"), "waypoints": json.dumps(waypoints)}
        mesh.tms("param", "set", f"zx200_2/{name}", *(f"{key}={value}" for key, value in values.items()), "--create")
    leaves = (("plan", "A", ""), ("plan", "B", "A"), ("execute_from_plan", "A,B", ""))
    file = tmp_path / "tree.xml"
    file.write_text(TREE.format("".join(LEAF.format(*leaf) for leaf in leaves)))
    number = str(json.loads(mesh.tms("task", "add", str(file), "--json").stdout)["task_id"])
    alone = mesh.tms("run", number, "--wait", "--ignore-warnings", expect=1)
    assert "planner of zx200_2 does not answer" in alone.stderr + alone.stdout
    with foreign_server(mesh, "planner", "zx200_2", form=FORM) as server:
        wait_until(lambda: succeeds(mesh, number), LIMIT, "our planner has found theirs")
        assert server.stdout is not None
        assert server.stdout.readline() == "1 arm\n"
        assert server.stdout.readline().startswith("1 arm 0.4 -0.8 2.0 0.8")


def test_a_latch_holds_for_their_primitive(mesh: Mesh) -> None:
    mesh.tms("stop", "zx200")
    try:
        words = ask(mesh, "excavator", "zx200", "boom_joint", "-0.7", form=FORM)
    finally:
        mesh.tms("rearm", "zx200", "--yes")
    assert words[:2] == [SUCCEEDED, "1"] and words[2:4] == [ABORTED, "99999"]  # it still plans
    assert float(words[4]) != pytest.approx(-0.7, abs=0.05)


def succeeds(mesh: Mesh, number: str) -> bool:
    done = mesh.tms("run", number, "--wait", "--json", "--ignore-warnings", expect=None)
    return '"success"' in done.stdout
