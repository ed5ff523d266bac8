"""The leaf nodes of version 6 of the C++ system, and the inputs of their goals."""

from __future__ import annotations

import pytest

from tms_machine.goal_inputs import parted
from tms_ts import tree_reasons as r
from tms_ts.bt import FAILURE, RUNNING, SUCCESS, Status, TickError, TreeError, check
from tms_ts.preflight import records_of
from tms_ts.world import GoalState
from unit.tms_ts.fakes import FakeMachines, FakeWorld
from unit.tms_ts.trees import document, ticked, tree

KINDS = ("Excavator", "CrawlerDump", "Bulldozer", "Common", "ExcavatorAssist")


def leaf(kind: str, ports: str = 'record_name="R"', primitive: str = "primitive_drive") -> str:
    return f'<Action  model_name="m1" ID="LeafNode{kind}" {ports} primitive_name="{primitive}"/>'


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(
    ("end", "status"), [(GoalState.SUCCEEDED, SUCCESS), (GoalState.FAILED, FAILURE), (GoalState.CANCELLED, FAILURE)]
)
def test_result_of_the_goal(kind: str, end: GoalState, status: Status) -> None:
    fake = FakeWorld(FakeMachines(lasts=3, end=end))
    one = tree(leaf(kind), fake=fake)
    assert [one.tick(), one.tick(), one.tick()] == [RUNNING, RUNNING, status]
    (goal,) = fake.machines.sent
    assert (goal.machine, goal.subtask, goal.record, goal.cancels) == ("m1", "primitive_drive", "R", 0)


@pytest.mark.parametrize("kind", KINDS)
def test_a_halt_cancels(kind: str) -> None:
    fake = FakeWorld(FakeMachines(lasts=100))
    one = tree(leaf(kind), fake=fake)
    one.tick()
    one.halt()
    assert [goal.cancels for goal in fake.machines.sent] == [1]


@pytest.mark.parametrize(
    ("kind", "ports", "record", "inputs"),
    [
        ("Excavator", 'record_name="A"', "A", {}),
        ("Excavator", 'target_record_name="A" previous_target_record_name=""', "A", {}),
        (
            "Excavator",
            'target_record_name="A" previous_target_record_name="B"',
            "A",
            {"previous_target_record_name": "B"},
        ),
        ("Excavator", 'target_record_name="A,B,C"', "A,B,C", {}),
        ("Excavator", 'target_record_name="A" record_name="B"', "A", {}),
        ("Excavator", 'target_record_name="" previous_target_record_name="" record_name="B"', "B", {}),
        ("Excavator", 'target_record_name="" record_name=""', "", {}),
        ("CrawlerDump", 'record_name="A" read_direction="down"', "A", {"read_direction": "down"}),
        ("CrawlerDump", 'record_name="{r}" read_direction="{way}"', "of key", {"read_direction": "up"}),
        ("CrawlerDump", 'record_name="A" read_direction=""', "A", {}),
        ("CrawlerDump", 'record_name="A" read_direction="{none}"', "A", {}),
        ("Bulldozer", 'record_name="A" blade_hold="true"', "A", {"blade_hold": True}),
        ("Bulldozer", 'record_name="A" blade_hold="{yes}"', "A", {"blade_hold": True}),
        ("Bulldozer", 'record_name="A" blade_hold="false"', "A", {}),
        ("Bulldozer", 'record_name="A" blade_hold=""', "A", {}),
        ("Bulldozer", 'record_name=""', "", {}),
    ],
)
def test_what_the_goal_gets(kind: str, ports: str, record: str, inputs: dict[str, str | bool]) -> None:
    fake = FakeWorld()
    keys = {"r": "of key", "way": "up", "yes": True}
    one = tree(leaf(kind, ports), fake=fake, blackboard=keys)
    one.tick()
    assert parted(fake.machines.sent[0].record) == (record, inputs)
    if "{" not in ports:
        assert parted(one.leaf_goals()[0].record) == (record, inputs), "known before the run"


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("ports", ["", 'record_name="{none}"'])
def test_a_record_that_is_not_given_fails_and_sends_nothing(kind: str, ports: str) -> None:
    fake = FakeWorld()
    one = tree(leaf(kind, ports), fake=fake)
    status, why = ticked(one)
    assert (status, type(why)) == (FAILURE, r.MissingParameter)
    assert fake.machines.sent == []
    said = r.NeverWritten("none", f"LeafNode{kind}") if ports else one.warnings[0][1]
    assert [what for _, what in one.warnings] == [said]
    assert ports or isinstance(said, r.AlwaysFails)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("port", ["model_name", "primitive_name"])
def test_it_is_not_loaded_without_machine_and_primitive(kind: str, port: str) -> None:
    with pytest.raises(TreeError, match=f"LeafNode{kind} needs '{port}'"):
        tree(leaf(kind).replace(port, "name"))


@pytest.mark.parametrize(
    ("kind", "port"),
    [("CrawlerDump", "blade_hold"), ("Bulldozer", "read_direction"), ("Common", "read_direction"),
     ("CrawlerDump", "target_record_name"), ("Excavator", "subtask_name"), ("Excavator", "blade_hold")],
)  # fmt: skip
def test_ports_of_other_kinds_are_refused(kind: str, port: str) -> None:
    with pytest.raises(TreeError, match=f"no port '{port}'"):
        tree(leaf(kind, f'record_name="R" {port}="x"'))


def test_an_empty_primitive_is_an_error_where_it_can_be_reached() -> None:
    empty = leaf("Bulldozer", primitive="")
    (error,) = check(document(f"<Sequence>\n{empty}</Sequence>")).errors
    assert (error.what, error.line, error.path) == (r.NameMissing("LeafNodeBulldozer", "primitive_name"), 4, "0.0")
    assert check(document("<AlwaysSuccess/>", empty)).ok, "a tree that nothing leads to"
    with pytest.raises(TickError):
        tree(empty).tick()
    with pytest.raises(TickError):
        tree(leaf("Bulldozer", primitive="{p}"), blackboard={"p": ""}).tick()


def test_the_same_holds_for_leaves_of_version_5() -> None:
    report = check(document('<Action ID="LeafNodeZx200" model_name="zx200" record_name="R" subtask_name=""/>'))
    assert [error.what for error in report.errors] == [r.NameMissing("LeafNodeZx200", "subtask_name")]


def test_a_leaf_of_a_kind_that_is_not_known_here() -> None:
    model = (
        '<TreeNodesModel><Action ID="LeafNodeRoller"><input_port name="model_name"/><input_port name="primitive_name"/>'
        '<input_port name="record_name"/></Action></TreeNodesModel>'
    )
    report = check(document(leaf("Roller"), model=model))
    assert [type(what) for _, what in report.warnings] == [r.AdoptedLeaf]
    assert [(goal.machine, goal.subtask, goal.record) for goal in report.goals] == [("m1", "primitive_drive", "R")]


def test_the_document_tells_goal_and_records() -> None:
    ports = 'target_record_name="A" previous_target_record_name="B"'
    both = leaf("Excavator", ports) + leaf("CrawlerDump", 'record_name="C" read_direction="{w}"')
    one = tree(f"<Sequence>{both}</Sequence>")
    assert [parted(goal.record) for goal in one.leaf_goals()] == [
        ("A", {"previous_target_record_name": "B"}), ("C", {"read_direction": "{w}"}),
    ]  # fmt: skip
    assert records_of(one) == ["m1/A", "m1/B", "m1/C"]


def test_both_generations_in_one_tree() -> None:
    fake = FakeWorld()
    old = '<Action ID="LeafNodeZx200" model_name="zx200" record_name="R" subtask_name="st_zx200_swing"/>'
    one = tree(f"<Sequence>{old}{leaf('CrawlerDump')}</Sequence>", fake=fake)
    while one.tick() is RUNNING:
        pass
    assert [goal.subtask for goal in fake.machines.sent] == ["st_zx200_swing", "primitive_drive"]
