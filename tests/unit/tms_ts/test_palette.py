"""The palette for Groot: every custom node, and only what Groot can read."""

from __future__ import annotations

from lxml import etree

from tms_ts.bt import check, palette, registry
from tms_ts.bt.document import read
from tms_ts.bt.reasons import PartWithoutColon

PALETTE = etree.fromstring(palette())


def test_every_custom_node_is_in_it() -> None:
    ids = [element.get("ID") for element in PALETTE.iterfind("TreeNodesModel/*[@ID]")]
    assert ids == sorted(["ExecuteSubtask", *(name for name, cls in registry().items() if not cls.builtin)])
    assert {"LeafNodeZx200", "KeepRunningUntilFlgup", "WaitForClick"} <= set(ids)


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


def test_every_node_is_described() -> None:
    comments = [str(comment.text).strip() for comment in PALETTE.iter(etree.Comment)]
    assert all(text.partition(": ")[2] for text in comments)
    assert len(comments) == len(PALETTE.findall("TreeNodesModel/*[@ID]"))


def test_it_is_a_document_of_ours() -> None:
    assert read(palette()).models["LeafNodeZx200"] == {"model_name", "record_name", "subtask_name"}
