"""Peers that speak LeafNodeBase as version 6 does: their leaves drive our subtasks, their servers serve our trees."""

import json
import os
import signal
from collections.abc import Iterator
from pathlib import Path

import pytest
from nav2_msgs.action import NavigateToPose
from tms_msg_rc.msg import MachineState

from conftest import NO_CONSOLE, PROJECT, Mesh, mesh_apart, node_in, running, wait_until
from tms_ros.goals import Outcome
from upstream_peers import ABORTED, SUCCEEDED, ask, asking, foreign_server

pytestmark = [pytest.mark.turns, pytest.mark.system]
MACHINES = {"mst110cr": "v6a", "mst110cr_2": "v6b"}
SITE = {
    "machines": {name: {"model": "mst110cr", "start": [10.0, 9.0 * row, 0.0]} for row, name in enumerate(MACHINES)},
    "peers": {name: {"leaf": form, "motions": True} for name, form in MACHINES.items()},
}
SWING = "primitive_crawlerdump_swing"
TREE = (
    '<root main_tree_to_execute="T"><BehaviorTree ID="T"><Action ID="{node}" model_name="{machine}" '
    'primitive_name="{name}" {ports}/></BehaviorTree></root>'
)
DRIVE = "primitive_crawlerdump_navigate_anywhere"
AWAY = ("x=2000.0", "y=9.0", "qx=0.0", "qy=0.0", "qz=0.0", "qw=1.0")  # m: a minute at five times its speed
LIMIT = 30.0  # s


@pytest.fixture(scope="module")
def mesh(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Mesh]:
    with mesh_apart(tmp_path_factory.mktemp("forms"), **NO_CONSOLE, **SITE) as made, running(made):
        for name in MACHINES:
            made.tms("param", "set", f"{name}/LEFT", "target_angle=0.6", "--create")
            made.tms("start", f"{name}:{SWING}")
        yield made


@pytest.mark.parametrize(
    ("machine", "further"), [("mst110cr", "previous_target_record_name=x"), ("mst110cr_2", "read_direction=down")]
)
def test_their_leaf_drives_our_subtask_with_its_inputs(mesh: Mesh, machine: str, further: str) -> None:
    form, words = MACHINES[machine], ("leaf", machine, SWING, "LEFT")
    assert ask(mesh, *words, form=form)[:2] == [SUCCEEDED, "True"]
    refused = ask(mesh, *words, further, form=form)  # a swing knows no direction
    assert (
        refused[:2] == [ABORTED, "False"] and refused[2] == "INPUTS_NOT_TAKEN" and further.split("=")[0] in refused[3]
    )


@pytest.mark.parametrize("lost", ["mst110cr_2:if", f"mst110cr_2:{DRIVE}"])
def test_a_goal_ends_with_the_border_or_the_subtask_that_has_passed_it_on(mesh: Mesh, lost: str) -> None:
    """Nobody could bring its cancel any more."""
    mesh.tms("param", "set", "mst110cr_2/AWAY", *AWAY, "--create")
    mesh.tms("start", f"mst110cr_2:{DRIVE}")
    goals: list[str] = []
    with node_in(mesh) as node, asking(mesh, "leaf", "mst110cr_2", DRIVE, "AWAY", form="v6b"):
        node.subscribe(MachineState, "/mst110cr_2/rc/state", lambda state: goals.append(state.goal), latched=True)
        wait_until(lambda: bool(goals and goals[-1]), LIMIT, "the truck drives")
        rows = json.loads(mesh.tms("ps", "--json").stdout)
        os.kill(next(row["pid"] for row in rows if row["name"] == lost), signal.SIGKILL)
        wait_until(lambda: not goals[-1], LIMIT, "the truck has no goal any more")
    mesh.wait_ready()


def test_their_primitive_drives_through_our_gateway(mesh: Mesh) -> None:
    goal = NavigateToPose.Goal()
    goal.pose.header.frame_id = "map"
    goal.pose.pose.position.x, goal.pose.pose.position.y, goal.pose.pose.orientation.w = 13.0, 0.0, 1.0
    with node_in(mesh) as node:
        peer = node.peer(NavigateToPose, "/mst110cr/tms_rp_navigate_anywhere")
        peer.wait_ready(LIMIT)
        call = peer.send(goal)
        wait_until(lambda: call.outcome is not None, LIMIT, "the truck is there")
    assert call.outcome is Outcome.SUCCEEDED


def test_a_motion_ends_with_the_border_that_has_passed_it_on(mesh: Mesh) -> None:
    goal, goals = NavigateToPose.Goal(), list[str]()
    goal.pose.header.frame_id = "map"
    goal.pose.pose.position.x, goal.pose.pose.orientation.w = 2000.0, 1.0
    with node_in(mesh) as node:
        peer = node.peer(NavigateToPose, "/mst110cr/tms_rp_navigate_anywhere")
        peer.wait_ready(LIMIT)
        node.subscribe(MachineState, "/mst110cr/rc/state", lambda state: goals.append(state.goal), latched=True)
        peer.send(goal)
        wait_until(lambda: bool(goals and goals[-1]), LIMIT, "the truck drives")
        rows = json.loads(mesh.tms("ps", "--json").stdout)
        os.kill(next(row["pid"] for row in rows if row["name"] == "mst110cr:if"), signal.SIGKILL)
        wait_until(lambda: not goals[-1], LIMIT, "the truck has no goal any more")
    mesh.wait_ready()


@pytest.mark.parametrize(
    ("machine", "node", "ports", "told"),
    [
        ("mst110cr", "LeafNodeExcavator", 'target_record_name="a" previous_target_record_name="b"', "mst110cr a b\n"),
        ("mst110cr_2", "LeafNodeCrawlerDump", 'record_name="a" read_direction="down"', "mst110cr_2 a down False \n"),
    ],
)
def test_their_server_serves_our_tree(
    mesh: Mesh, tmp_path: Path, machine: str, node: str, ports: str, told: str
) -> None:
    number = stored(mesh, tmp_path, machine, node, ports)
    with foreign_server(mesh, "serve", machine, "primitive_of_theirs", form=MACHINES[machine]) as server:
        wait_until(lambda: succeeds(mesh, number), LIMIT, "the border has found their server")
        assert server.stdout is not None and server.stdout.readline() == told


def test_their_scheduler_reads_our_templates(mesh: Mesh) -> None:
    file = PROJECT / "configs" / "templates" / "Excavate_combined.xml"
    mesh.tms("template", "add", str(file))
    assert ask(mesh, "template", "Excavate_combined", form="param_type") == file.read_text(encoding="utf-8").split()
    assert ask(mesh, "template", "nobody_has_it", form="both") == []


def test_an_input_that_their_form_has_no_field_for_refuses_the_goal(mesh: Mesh, tmp_path: Path) -> None:
    ports = 'record_name="a" read_direction="down"'
    number = stored(mesh, tmp_path, "mst110cr", "LeafNodeCrawlerDump", ports)
    with foreign_server(mesh, "serve", "mst110cr", "primitive_of_theirs", form="v6a"):
        wait_until(
            lambda: "takes no read_direction" in outcome(mesh, number), LIMIT, "the border has found their server"
        )


def test_a_server_in_another_form_than_declared_refuses_the_run(mesh: Mesh, tmp_path: Path) -> None:
    number = stored(mesh, tmp_path, "mst110cr_2", "LeafNodeCrawlerDump", 'record_name="a"', "primitive_of_others")
    with foreign_server(mesh, "serve", "mst110cr_2", "primitive_of_others", form="v6a"):
        wait_until(
            lambda: "speaks LeafNodeBase as v6a" in outcome(mesh, number), LIMIT, "the border has found their server"
        )


def stored(mesh: Mesh, folder: Path, machine: str, node: str, ports: str, name: str = "primitive_of_theirs") -> str:
    file = folder / "tree.xml"
    file.write_text(TREE.format(machine=machine, node=node, ports=ports, name=name))
    return str(json.loads(mesh.tms("task", "add", str(file), "--json").stdout)["task_id"])


def outcome(mesh: Mesh, number: str) -> str:
    done = mesh.tms("run", number, "--wait", "--json", "--ignore-warnings", expect=None)
    return done.stdout + done.stderr


def succeeds(mesh: Mesh, number: str) -> bool:
    return '"success"' in outcome(mesh, number)
