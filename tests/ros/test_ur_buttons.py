"""The console process with nodes of the C++ system's version 6: a permission starts the tasks of the site file."""

from pathlib import Path

import pytest
from diagnostic_msgs.msg import KeyValue
from tms_msg_ts.action import ExecuteTask

from conftest import wait_until
from console_process import LIMIT, running
from tms_config.config import Site
from tms_ros.goals import Ended, Outcome
from tms_ros.node import Ros
from tms_ros.server import Goal

pytestmark = pytest.mark.ros


def test_a_permission_starts_the_task(site: Site, ros: Ros, tmp_path: Path) -> None:
    with site.path.open("a") as file:
        file.write("console: {buttons: [4]}\n")
    started: list[tuple[int, bool]] = []
    requests: list[tuple[str, str]] = []

    def execute(goal: Goal[ExecuteTask.Goal, ExecuteTask.Feedback]) -> Ended[ExecuteTask.Result]:
        started.append((goal.request.task_id, goal.request.ignore_warnings))
        return Outcome.SUCCEEDED, ExecuteTask.Result(run_id="r-1", outcome="success")

    ros.serve(ExecuteTask, "/tms/execute_task", execute)
    ros.subscribe(KeyValue, "/permissionrequest", lambda asked: requests.append((asked.key, asked.value)))
    permission = ros.publisher(KeyValue, "/urpermission")
    with running(site, tmp_path) as console:
        wait_until(lambda: permission.get_subscription_count() == 1 and bool(requests), LIMIT, "the console listens")
        permission.publish(KeyValue(key="TASKGUI", value="true"))
        wait_until(lambda: bool(started), LIMIT, lambda: f"a start\n{console.log.read_text()}")
    assert started == [(4, False)] and set(requests) == {("TASKGUI", "4")}
