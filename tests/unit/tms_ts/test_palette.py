"""The palette for Groot: every custom node, and only what Groot can read."""

from __future__ import annotations

import pytest
from lxml import etree

from tms_ts.bt import check, palette, registry
from tms_ts.bt.document import read
from tms_ts.tree_reasons import PartWithoutColon

PALETTE = etree.fromstring(palette())


def test_every_custom_node_is_in_it() -> None:
    ids = [element.get("ID") for element in PALETTE.iterfind("TreeNodesModel/*[@ID]")]
    assert ids == sorted(["ExecuteSubtask", *(name for name, cls in registry().items() if not cls.builtin)])
    assert {"LeafNodeZx200", "KeepRunningUntilFlgup", "WaitForClick"} <= set(ids)


def test_the_editor_is_told_of_builtin_nodes_too() -> None:
    entries = etree.fromstring(palette(builtin=True)).findall("TreeNodesModel/*[@ID]")
    builtin = {entry.get("ID") for entry in entries if entry.get("builtin") == "true"}
    assert builtin == {name for name, cls in registry().items() if cls.builtin}
    assert {entry.get("ID") for entry in entries} - builtin == {
        entry.get("ID") for entry in PALETTE.iter() if entry.get("ID")
    }


def test_an_entry_has_category_ports_defaults_and_texts() -> None:
    entry = PALETTE.find("TreeNodesModel/Action[@ID='LeafNodeIc120']")
    assert entry is not None
    assert [port.attrib for port in entry] == [
        {"name": "model_name", "type": "std::string", "default": "ic120"},
        {"name": "record_name", "type": "std::string"},
        {"name": "subtask_name", "type": "std::string"},
    ]
    assert all(port.tag == "input_port" and port.text for port in entry)
    assert PALETTE.find("TreeNodesModel/Decorator[@ID='KeepRunningUntilFlgup']/input_port[@name='key']") is not None
    assert PALETTE.find("TreeNodesModel/Action[@ID='BlackboardValueChecker']/inout_port") is not None


def test_a_call_of_a_template_that_groot_draws_is_one() -> None:
    entry = PALETTE.find("TreeNodesModel/Action[@ID='ExecuteSubtask']")
    assert entry is not None
    drawn = "".join(f' {port.get("name")}="T"' for port in entry)  # Groot writes the ID first, then all ports
    template = (
        '<root><BehaviorTree ID="B"><AlwaysSuccess name="$model_name$$terminate_condition$"/></BehaviorTree></root>'
    )
    text = f'<root><BehaviorTree ID="M"><Action ID="ExecuteSubtask"{drawn}/></BehaviorTree>'
    report = check(f"{text}{etree.tostring(PALETTE[0], encoding='unicode')}</root>", templates={"T": template}.get)
    assert report.errors == []
    assert [type(warning) for _, warning in report.warnings] == [PartWithoutColon]


NODES = {  # of the C++ system, by the versions that have them
    "(version 5)": {"LeafNodeZx200", "LeafNodeIc120", "LeafNodeMst110cr", "LeafNodeMst2200", "LeafNodeD37pxi",
                    "BlackboardValueReaderMongo"},
    "(version 6)": {"LeafNodeExcavator", "LeafNodeExcavatorAssist", "LeafNodeCrawlerDump", "LeafNodeBulldozer",
                    "LeafNodeCommon", "MongoValueReader", "MongoValueSearcher", "BlackboardValueSearcherMongo",
                    "MongoArrayWriter", "LocalBlackboardCaluculator", "WaitTimer", "ExecuteSubtask"},
    "(versions 5 and 6)": {"MongoValueWriter", "ConditionalExpression", "KeepRunningUntilFlgup", "SetLocalBlackboard",
                           "SetLocalBlackboardWithCounter", "Counter", "WaitForClick"},
}  # fmt: skip


def test_both_generations_are_offered_and_marked() -> None:
    comments = [str(comment.text).strip().partition(": ")[0] for comment in PALETTE.iter(etree.Comment)]
    marked = {mark: {one.removesuffix(mark).strip() for one in comments if one.endswith(mark)} for mark in NODES}
    assert marked == NODES
    for mark in ("(version 5)", "(version 6)"):
        for name in NODES[mark]:
            ports = PALETTE.findall(f"TreeNodesModel/*[@ID='{name}']/*")
            assert ports and all((port.text or "").endswith(mark) for port in ports), "Groot shows no comments"


PORTS = {
    "LeafNodeExcavator": "model_name:I previous_target_record_name:I primitive_name:I target_record_name:I",
    "LeafNodeCrawlerDump": "model_name:I primitive_name:I read_direction:I record_name:I",
    "LeafNodeBulldozer": "blade_hold:I model_name:I primitive_name:I record_name:I",
    "LeafNodeCommon": "model_name:I primitive_name:I record_name:I",
    "LeafNodeExcavatorAssist": "model_name:I primitive_name:I record_name:I",
    "MongoValueReader": "mongo_param_name:I mongo_record_name:I output_port:I",
    "MongoValueSearcher": "mongo_param_name:I mongo_value:I output_port:O",
    "BlackboardValueSearcherMongo": "mongo_param_name:I mongo_value:I output_port:O",
    "MongoValueWriter": "input_type:I input_value:I mongo_param_name:I mongo_record_name:I",
    "MongoArrayWriter": "input_value:I mongo_param_name:I mongo_record_name:I operation:I",
    "KeepRunningUntilFlgup": "key:I while_or_dowhile:I",
    "ConditionalExpression": "conditional_expression:I",
    "SetLocalBlackboard": "output_key:B value:I",
    "LocalBlackboardCaluculator": "calculation_formula:I output_key:I",
    "SetLocalBlackboardWithCounter": "counter_key:B key:I",
    "Counter": "key:I",
    "WaitTimer": "seconds:I=1.0",
    "WaitForClick": "button_info:I= window_title:I=",
}


@pytest.mark.parametrize("name", PORTS)
def test_the_ports_of_version_6(name: str) -> None:
    directions = {"input_port": "I", "output_port": "O", "inout_port": "B"}
    ports = PALETTE.findall(f"TreeNodesModel/*[@ID='{name}']/*")
    found = [
        f"{port.get('name')}:{directions[str(port.tag)]}"
        + (f"={port.get('default')}" if "default" in port.attrib else "")
        for port in ports
    ]
    assert " ".join(sorted(found)) == PORTS[name]


def test_every_node_is_described() -> None:
    comments = [str(comment.text).strip() for comment in PALETTE.iter(etree.Comment)]
    assert all(text.partition(": ")[2] for text in comments)
    assert len(comments) == len(PALETTE.findall("TreeNodesModel/*[@ID]"))


def test_it_is_a_document_of_ours() -> None:
    assert read(palette()).models["LeafNodeZx200"] == {"model_name", "record_name", "subtask_name"}
