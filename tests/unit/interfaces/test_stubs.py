"""The stubs of ROS interfaces: what mypy is told of each is what rosidl made of it."""

import subprocess
import sys
from pathlib import Path

from com3_msgs import action
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs import msg
from geometry_msgs.msg import PoseWithCovariance
from rcl_interfaces.msg import ParameterType
from sensor_msgs.msg import JointState, PointCloud2
from std_msgs.msg import Empty
from std_srvs.srv import Trigger

from conftest import PROJECT
from interfaces._wheel import stubs

NUMBERS = "collections.abc.Sequence[float] | numpy.typing.NDArray[numpy.float64]"


def test_values_messages_and_lists_of_others_than_numbers() -> None:
    lines = stubs.message_body(PointCloud2)
    assert {"height: int", "is_dense: bool", "header: std_msgs.msg.Header"} <= set(lines)
    assert "def fields(self) -> list[sensor_msgs.msg.PointField]: ..." in lines
    assert "def fields(self, value: collections.abc.Sequence[sensor_msgs.msg.PointField]) -> None: ..." in lines


def test_numbers_are_read_as_the_array_that_rosidl_makes_of_them() -> None:
    lines = stubs.message_body(JointState)
    assert "def position(self) -> array.array[float]: ..." in lines
    assert f"def position(self, value: {NUMBERS}) -> None: ..." in lines
    fixed = stubs.message_body(PoseWithCovariance)
    assert "def covariance(self) -> numpy.typing.NDArray[numpy.float64]: ..." in fixed
    assert f"def covariance(self, value: {NUMBERS}) -> None: ..." in fixed


def test_a_constructor_takes_any_of_the_fields() -> None:
    first = next(line for line in stubs.message_body(PoseWithCovariance) if "__init__" in line)
    assert f"(self, *, pose: geometry_msgs.msg.Pose = ..., covariance: {NUMBERS} = ...) -> None" in first
    assert "def __init__(self) -> None: ..." in stubs.message_body(Empty)[-3:]


def test_constants_are_of_the_class() -> None:
    assert "PARAMETER_BOOL: typing.ClassVar[int]" in stubs.message_body(ParameterType)
    assert "ERROR: typing.ClassVar[bytes]" in stubs.message_body(DiagnosticStatus)


def test_the_parts_of_a_service_and_an_action_are_nested_in_it() -> None:
    lines = stubs.class_lines("Trigger", Trigger)
    assert {"class Trigger:", "    class Request:", "    class Response:", "        success: bool"} <= set(lines)
    assert not any("Event" in line for line in lines)
    lines = stubs.class_lines("SetDumpAngle", action.SetDumpAngle)
    assert {f"    class {name}:" for name in ("Goal", "Result", "Feedback", "Impl")} <= set(lines)
    assert "            feedback: com3_msgs.action.SetDumpAngle.Feedback" in lines
    assert "        CancelGoalService = action_msgs.srv.CancelGoal" in lines


def test_a_stub_imports_what_it_names() -> None:
    assert "import std_msgs.msg\n" in stubs.module_text(msg)
    assert "import action_msgs.msg\nimport action_msgs.srv\n" in stubs.module_text(action)


def test_an_older_stub_leaves_nothing_behind(tmp_path: Path) -> None:
    old = tmp_path / "std_srvs-stubs" / "msg" / "__init__.pyi"
    old.parent.mkdir(parents=True)
    old.touch()
    stubs.write("std_srvs", tmp_path)
    assert not old.exists()
    assert (tmp_path / "std_srvs-stubs" / "srv" / "__init__.pyi").exists()


def test_mypy_sees_the_installed_stubs(tmp_path: Path) -> None:
    reported = {
        "JointState(name=['a'], position=(1.0, 2))": "",
        "JointState(position=['a'])": "List item 0 has incompatible type",
        "JointState(positions=[])": "Unexpected keyword argument",
        "JointState().position.real": '"array[float]" has no attribute "real"',
    }
    (tmp_path / "use.py").write_text("\n".join(["from sensor_msgs.msg import JointState", *reported]))
    command = [sys.executable, "-m", "mypy", "--strict", "--config-file=", f"--cache-dir={PROJECT}/.mypy_cache/stubs"]
    done = subprocess.run([*command, "use.py"], cwd=tmp_path, capture_output=True, text=True, timeout=120, check=False)
    for number, error in enumerate(reported.values(), start=2):
        found = [line for line in done.stdout.splitlines() if line.startswith(f"use.py:{number}: error:")]
        assert [error in line for line in found] == ([True] if error else []), done.stdout
