"""A run keeps the templates that it began with, tells where its nodes come from, and is checked with them."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from builtin_interfaces.msg import Time
from tms_msg_db.msg import Task, Template
from tms_msg_db.srv import GetTemplate
from tms_msg_ts.srv import CheckTask

from tms_reason.errors import TaskError
from tms_reason.reason import Foreign
from tms_reason.wire import to_line
from tms_ts import bt
from tms_ts.execution import Execution
from tms_ts.facts import Facts
from tms_ts.group_commit import GroupCommit
from tms_ts.interrupted_run import InterruptedRun
from tms_ts.preflight import Findings
from tms_ts.run import Run
from tms_ts.run_checkpoint import Records
from tms_ts.task_check import TaskCheck
from words import words

CALLS = """<root><BehaviorTree ID="M"><Sequence><AlwaysSuccess/>
<Action ID="ExecuteSubtask" subtask_name="Dig" model_name="zx200"/></Sequence></BehaviorTree></root>"""
OLD, NEW = (
    '<root><BehaviorTree ID="BehaviorTree">'
    f'<LeafNodeZx200 model_name="$model_name$" record_name="{record}" subtask_name="dig"/></BehaviorTree></root>'
    for record in ("old", "new")
)


class Stored:
    """The database: answers as tms:db does."""

    def __init__(self, **templates: str) -> None:
        self.templates = templates

    def call(self, kind: Any, name: str, request: Any, limit: float) -> Any:
        assert (kind, name) == (GetTemplate, "/tms/db/get_template")
        if request.template_name in self.templates:
            return GetTemplate.Response(stored=Template(task_sequence=self.templates[request.template_name]))
        code = "TEMPLATE_MISSING" if request.template_name != "broken" else "BAD_RECORD"
        return GetTemplate.Response(error_code=code, error_msg=to_line(Foreign("so")))


@pytest.fixture
def stored() -> Stored:
    return Stored(Dig=OLD)


@pytest.fixture
def execution(stored: Stored) -> Execution:
    check = TaskCheck.__new__(TaskCheck)
    check._app = SimpleNamespace(ros=stored)  # type: ignore[assignment]
    check.task = lambda _: Task(description="digs", task_sequence=CALLS)  # type: ignore[method-assign]
    check.before_run = lambda _: Findings()  # type: ignore[method-assign]
    runs = SimpleNamespace(hold=lambda _: None)
    leases = SimpleNamespace(take=lambda _: None)
    return Execution(SimpleNamespace(app=SimpleNamespace(ros=None), check=check, runs=runs, leases=leases))  # type: ignore[arg-type]


def facts() -> Facts:
    return Facts("run-1", 7, 3, "", [], Time())


def begun(execution: Execution, records: Records, past: InterruptedRun | None = None) -> bt.Tree:
    """The tree of a run as its scheduler makes it, with its checkpoint."""
    xml, templates = execution._xml(facts(), past)
    tree = bt.load(xml, templates=templates)
    run = SimpleNamespace(
        facts=facts(), record=records.open("run-1"), enter=lambda *_: None, publish_tree=lambda _: None
    )
    execution._begin(run, tree, xml, resumed=past is not None)  # type: ignore[arg-type]
    return tree


def test_a_resumed_run_has_the_templates_of_its_start(
    tmp_path: Path, disk: GroupCommit, execution: Execution, stored: Stored
) -> None:
    records = Records(tmp_path, disk)
    assert begun(execution, records).leaf_goals()[0].record == "old"
    stored.templates["Dig"] = NEW
    (past,) = records.past()
    assert begun(execution, records, past).leaf_goals()[0].record == "old"
    stored.templates.clear()
    (past,) = records.past()  # resumed, and interrupted again
    assert begun(execution, records, past).leaf_goals()[0].record == "old"
    stored.templates["Dig"] = NEW
    assert begun(execution, records).leaf_goals()[0].record == "new"


def test_a_checkpoint_of_an_earlier_release_has_no_templates() -> None:
    line = {
        "run_id": "r",
        "number": 1,
        "task_id": 2,
        "description": "",
        "machines": [],
        "xml": CALLS,
        "started": [1, 2],
    }
    header = InterruptedRun([{"run": line}]).header
    assert header is not None and header.templates == {}


def test_the_event_of_the_tree_tells_where_its_nodes_come_from() -> None:
    told: list[Any] = []
    run: Any = SimpleNamespace(log_event=lambda *words: told.append(words))
    Run.publish_tree(run, bt.load(CALLS, templates={"Dig": OLD}.get))
    ((_, _, _, values),) = told
    assert dict(zip(values["paths"], values["templates"], strict=True)) == {"0": "", "0.0": "", "0.1": "Dig:1"}
    told.clear()
    Run.publish_tree(run, bt.load('<root><BehaviorTree ID="M"><AlwaysSuccess/></BehaviorTree></root>'))
    assert "templates" not in told[0][3]


def test_the_check_reads_templates(execution: Execution, stored: Stored) -> None:
    check = execution._parts.check
    seen: list[bt.Tree] = []
    check._preflight = lambda tree, **_: seen.append(tree) or Findings()  # type: ignore[method-assign, func-returns-value]
    assert not check.check(CheckTask.Request(xml=CALLS), CheckTask.Response()).errors
    assert seen[0].leaf_goals()[0].record == "old"
    stored.templates.clear()
    (error,) = check.check(CheckTask.Request(xml=CALLS), CheckTask.Response()).errors
    assert words(error) == "line 2: there is no template 'Dig'"
    broken = check.check(CheckTask.Request(xml=CALLS.replace("Dig", "broken")), CheckTask.Response())
    assert (broken.error_code, broken.errors) == ("BAD_RECORD", [])


def test_a_run_whose_template_cannot_be_read_does_not_begin(execution: Execution, stored: Stored) -> None:
    xml, templates = execution._xml(facts(), None)
    with pytest.raises(TaskError, match="so"):
        bt.load(xml.replace("Dig", "broken"), templates=templates)
