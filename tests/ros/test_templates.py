"""A real scheduler runs a task with templates; a run that it has lost is resumed with those of its start.

One that was sent to it as it got lost goes to its successor.
"""

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from tms_msg_db.srv import AddTask, AddTemplate, ListEvents, ListRuns, RemoveTemplate
from tms_msg_ts.action import ExecuteTask
from tms_msg_ts.srv import CancelRun, CheckTask

from few_processes import LIMIT, SITE, Mesh, bare
from tms_machine.values import from_parameters
from tms_schedulers import sending
from tms_schedulers.sending import ExecuteCall
from words import words

pytestmark = pytest.mark.ros
TASK = """<root><BehaviorTree ID="M"><Sequence>
<Action ID="ExecuteSubtask" subtask_name="Wait" subtask_parameters="ms:60000"/></Sequence></BehaviorTree></root>"""
WAIT = """<root main_tree_to_execute="BehaviorTree"><BehaviorTree ID="BehaviorTree">
<Delay delay_msec="$ms$"><AlwaysSuccess name="{}"/></Delay></BehaviorTree><TreeNodesModel/></root>"""


class Scheduled(Mesh):
    """With a scheduler."""

    SITE = SITE.replace("services: {{", "services: {{ts: {{role: cps}}, ")


@pytest.fixture
def mesh(tmp_path: Path, own_domain: int) -> Iterator[Mesh]:
    """A mesh with store, database and scheduler, and one task."""
    for mesh in bare(tmp_path, own_domain, Scheduled):
        for name in ("tms:store", "tms:db", "tms:ts"):
            mesh.start(name)
        mesh.wait_ready()
        assert mesh.db(AddTask, "add_task", task_sequence=TASK).task_id == 1
        yield mesh


def send(mesh: Mesh, **goal: object) -> ExecuteCall:
    return sending.send(mesh.ros.peer(ExecuteTask, "/tms/execute_task"), ExecuteTask.Goal(**goal))


def begun(mesh: Mesh, **goal: object) -> str:
    """The run of a goal once its tree is ticked."""
    call = send(mesh, **goal)
    running = lambda: call.feedback is not None and call.feedback.state == "running"  # noqa: E731
    assert call.wait_for(lambda: running() or call.outcome is not None, LIMIT)
    assert call.outcome is None, words(call.result.error_msg)
    return str(call.feedback.run_id)


def shapes(mesh: Mesh, run: str) -> list[dict[str, str]]:
    """The trees in the history of a run: name of each node, and where in a template it stands."""
    events = [event for event in mesh.db(ListEvents, "list_events", run_id=run).events if event.kind == "tree"]
    found = [from_parameters(event.values) for event in events]
    return [dict(zip(one["names"], one["templates"], strict=True)) for one in found]


def state(mesh: Mesh, run: str) -> str:
    return next((one.state for one in mesh.db(ListRuns, "list_runs").runs if one.run_id == run), "")


def test_a_run_keeps_the_templates_of_its_start(mesh: Mesh) -> None:
    (error,) = mesh.call(CheckTask, "/tms/check_task", task_id=1).errors
    assert words(error) == "line 2: there is no template 'Wait'"
    refused = send(mesh, task_id=1)
    assert refused.wait_for(lambda: refused.outcome is not None, LIMIT)
    assert words(refused.result.error_msg) == "line 2: there is no template 'Wait'"
    mesh.db(AddTemplate, "add_template", template_name="Wait", task_sequence=WAIT.format("old"))
    assert not mesh.call(CheckTask, "/tms/check_task", task_id=1).errors
    run = begun(mesh, task_id=1)
    old = {"Sequence": "", "Delay": "Wait:2", "old": "Wait:2"}
    mesh.until(lambda: shapes(mesh, run) == [old], "the tree in the history")
    mesh.kill("tms:ts")
    mesh.db(AddTemplate, "add_template", template_name="Wait", task_sequence=WAIT.format("new"), replace=True)
    mesh.start("tms:ts")
    mesh.until(lambda: state(mesh, run) == "interrupted", "interrupted run")
    mesh.db(RemoveTemplate, "remove_template", template_name="Wait")
    assert begun(mesh, resume=run) == run
    mesh.until(lambda: shapes(mesh, run) == [old, old], "the tree of the resumed run")
    assert mesh.call(CancelRun, "/tms/cancel_run", run_id=run).error_code == ""
    mesh.until(lambda: state(mesh, run) == "cancelled", "cancelled run")


def test_a_run_that_got_lost_with_its_scheduler_goes_to_the_successor(mesh: Mesh) -> None:
    mesh.db(AddTemplate, "add_template", template_name="Wait", task_sequence=WAIT.format("w"))
    mesh.call(CheckTask, "/tms/check_task", task_id=1)
    scheduler = mesh.ros.peer(ExecuteTask, "/tms/execute_task")
    scheduler.wait_ready(LIMIT)
    mesh.kill("tms:ts")
    with ThreadPoolExecutor() as pool:
        sent = pool.submit(sending.send, scheduler, ExecuteTask.Goal(task_id=1))
        mesh.start("tms:ts")
        call = sent.result(LIMIT)
    assert call.wait_for(lambda: call.accepted, LIMIT)
