"""Registers a task file: the ROS node of the paper, with the parameter `bt_tree_xml_file_name`.

python -m tms_db.task_generator --ros-args -p bt_tree_xml_file_name:=one_loading_cycle -p description:="Loads once"
"""

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tms_config.config import CONFIGS, load_site
from tms_db import task_text
from tms_db.reasons import NoFileGiven, NoSuchFile
from tms_reason.errors import DbError, TaskError, TmsError
from tms_reason.wire import refusal
from tms_runtime import environment
from tms_runtime.last_resort import LEAVE_LIMIT, end_after

if TYPE_CHECKING:
    from tms_ros.node import Ros

TASKS = CONFIGS / "tasks"
ANSWER = 10.0  # s


def find(name: str) -> Path:
    """Find a task file by a path, or by a name below configs/tasks/ with or without .xml.

    Raises:
        TaskError: there is none.
    """
    if not name:
        raise TaskError(NoFileGiven())
    for path in (Path(name), TASKS / f"{name}.xml", TASKS / name):
        if path.is_file():
            return path
    raise TaskError(NoSuchFile(name, str(TASKS)))


def main() -> int:
    """Register and print the number; 0 when the task is stored (also when it was before)."""
    try:
        environment.enter(load_site())
    except TmsError as error:
        sys.stderr.write(f"{error}\n")
        return 1
    from tms_ros.node import Ros  # after the environment is set, which rclpy reads

    ros = Ros("task_generator")
    code = _say(ros)
    ros.stop()
    end_after(LEAVE_LIMIT, code)
    ros.leave()
    return code


def _say(ros: "Ros") -> int:
    try:
        sys.stdout.write(f"{_register(ros)}\n")
        sys.stdout.flush()
    except TmsError as error:
        sys.stderr.write(f"{error}\n")
        return 1
    return 0


def _register(ros: "Ros") -> str:
    from rcl_interfaces.msg import ParameterDescriptor
    from tms_msg_db.srv import AddTask

    loose = ParameterDescriptor(dynamic_typing=True)  # a name or a description may look like a number

    def given(name: str) -> str:
        value: Any = ros.node.declare_parameter(name, "", loose).value
        return str(value)

    text = task_text.read_file(find(given("bt_tree_xml_file_name")))
    request = AddTask.Request(task_sequence=text, description=given("description"))
    answer = ros.call(AddTask, "/tms/db/add_task", request, ANSWER)
    if answer.error_code:
        raise DbError(refusal(answer.error_code, answer.error_msg), answer.error_code)
    return f"task {answer.task_id}" + (" (was stored before)" if answer.already_stored else "")


if __name__ == "__main__":
    sys.exit(main())
