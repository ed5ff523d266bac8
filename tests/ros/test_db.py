"""The database process with a real store: typed values through ROS, and a store that goes away and comes back."""

import json
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from builtin_interfaces.msg import Time
from PIL import Image
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from sensor_msgs.msg import JointState, PointCloud2
from tms_msg_db.msg import Event, Run, TmsdbGridFS
from tms_msg_db.srv import (
    AddTask,
    AddTemplate,
    GetParameter,
    GetTask,
    GetTemplate,
    ListEvents,
    ListParameters,
    ListRuns,
    ListTasks,
    ListTemplates,
    ReadRecording,
    RemoveParameter,
    RemoveTask,
    RemoveTemplate,
    SetParameter,
    TerrainStaticSrv,
    TmsdbGetData,
    TmsdbGetTask,
    TmsdbTerrainImageSrv,
    WriteJournal,
)
from tms_msg_ts.msg import RunState, RunStates

import programs
from few_processes import LIMIT, SITE, Mesh, bare
from tms_areas.trackers import Tracker
from tms_config.clock import unix_time
from tms_config.config import CONFIGS
from tms_db import store, store_address
from tms_db.terrain import Terrain
from tms_db.terrain_files import Size
from tms_machine.values import to_parameters
from tms_sensors.tracker_records import Told, TrackerRecords
from words import words

pytestmark = [
    pytest.mark.ros,
    pytest.mark.filterwarnings("ignore:module 'sre_:DeprecationWarning"),  # a parser that the ROS wheels bring
]


@pytest.fixture
def mesh(tmp_path: Path, own_domain: int) -> Iterator[Mesh]:
    """A mesh with the store and the database process up."""
    for mesh in bare(tmp_path, own_domain, Mesh):
        mesh.start("tms:store")
        mesh.start("tms:db")
        mesh.wait_ready()
        yield mesh


class OneMachine(Mesh):
    """With a machine whose runs are recorded."""

    SITE = SITE.replace("machines: {{}}", "machines: {{zx200: {{model: zx200}}}}")


@pytest.fixture
def bare_mesh(tmp_path: Path, own_domain: int) -> Iterator[Mesh]:
    """A mesh where nothing runs yet."""
    yield from bare(tmp_path, own_domain, OneMachine)


TREE = '<root>\n  <BehaviorTree ID="A"><Action ID="X" model_name="zx200" say="a&#10;b"/></BehaviorTree>\n</root>'
STORED = TREE.replace("\n", "").replace("  ", "")
KINDS = {
    "i": ParameterValue(type=ParameterType.PARAMETER_INTEGER, integer_value=-3),
    "d": ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=3.0),
    "b": ParameterValue(type=ParameterType.PARAMETER_BOOL, bool_value=True),
    "s": ParameterValue(type=ParameterType.PARAMETER_STRING, string_value="4"),
    "ii": ParameterValue(type=ParameterType.PARAMETER_INTEGER_ARRAY, integer_array_value=[1, 2]),
    "dd": ParameterValue(type=ParameterType.PARAMETER_DOUBLE_ARRAY, double_array_value=[1.0, 2.5]),
    "bb": ParameterValue(type=ParameterType.PARAMETER_BOOL_ARRAY, bool_array_value=[True, False]),
    "ss": ParameterValue(type=ParameterType.PARAMETER_STRING_ARRAY, string_array_value=["a", "待機"]),
}
VALUES = [Parameter(name=name, value=value) for name, value in KINDS.items()]


def test_tasks_records_and_history_through_ros(mesh: Mesh) -> None:
    tasks(mesh)
    templates(mesh)
    records(mesh)
    history(mesh)
    cpp_names(mesh)
    registration_node(mesh)
    terrain(mesh)
    trackers(mesh)
    backup(mesh)


def backup(mesh: Mesh) -> None:
    """While tms:db runs: it goes on with the restored documents."""

    def tms(*words: object) -> dict[str, object]:
        done = programs.tms(("--site", mesh.site.path, "db", *map(str, words), "--json"), mesh.environment, 60)
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)

    def records() -> list[tuple[str, str]]:
        return [(one.model_name, one.record_name) for one in mesh.db(ListParameters, "list_parameters").records]

    file = mesh.log.with_name("site.archive")
    before = records()
    assert tms("backup", file)["bytes"] == file.stat().st_size
    mesh.db(SetParameter, "set_parameter", model_name="zx200", record_name="late", values=VALUES, create=True)
    assert len(records()) == len(before) + 1
    ended = Time(sec=2)
    for one in mesh.db(ListRuns, "list_runs", limit=100).runs:  # runs of this test that were left open
        if not one.ended_at.sec:
            one.ended_at = ended
            mesh.db(WriteJournal, "write_journal", runs=[one])
    tms("restore", file, "--drop", "--yes")
    mesh.until(lambda: records() == before, "records as they were")
    assert len(mesh.db(ListTasks, "list_tasks").tasks) == tms("info")["documents"]["task"]  # type: ignore[index]
    assert mesh.ready()[0] == 200


def trackers(mesh: Mesh) -> None:
    """People that a sensing PC tells in a record."""
    told = TrackerRecords(mesh.ros, {"tags": Tracker(kind="person", record="people")})
    values = to_parameters({"x": [1.0, 3.5], "y": [2.0, 4.5]})
    mesh.db(SetParameter, "set_parameter", record_name="people", values=values, create=True)
    found: list[Told] = []
    mesh.until(lambda: bool(found.extend(told.take()) or found), "the record was read")
    assert found[-1].places() == [(1.0, 2.0), (3.5, 4.5)] and 0 <= found[-1].age() < LIMIT


def terrain(mesh: Mesh) -> None:
    """A heightmap out of the store, and a cloud in and out; what is not there is an empty answer."""
    heights = np.arange(500 * 400, dtype=np.uint32).astype(np.uint16).reshape(400, 500)
    file = mesh.log.with_name("yard.png")
    Image.fromarray(heights).save(file)
    db = store.connect(store_address.uri(mesh.site), "rostmsdb")
    Terrain(db).add(file, "heightmap", Size(120.0, 80.0, 14.0, -24.0))
    db.client.close()
    found = mesh.db(TmsdbTerrainImageSrv, "terrain_image", type="heightmap", id=4031)
    assert (found.filename, found.id, found.terrainwidth, found.offset_x) == ("yard.png", 4031, 120.0, -24.0)
    assert (found.image.encoding, bytes(found.image.data)) == ("mono16", heights.tobytes())
    assert mesh.db(TmsdbTerrainImageSrv, "terrain_image", type="texture").filename == ""
    assert mesh.db(TmsdbTerrainImageSrv, "terrain_image", type="fog").filename == ""
    assert len(mesh.db(TerrainStaticSrv, "terrain_cloud", type="dynamic").pointcloud2.data) == 0
    sent = PointCloud2(height=1, width=1000, point_step=12, row_step=12000, is_dense=True, data=bytes(range(240)) * 50)
    sent.header.frame_id = "map"
    publisher = mesh.ros.publisher(TmsdbGridFS, "/tms_db_gridfs_data")
    mesh.until(lambda: publisher.get_subscription_count() == 1, "subscription")
    publisher.publish(TmsdbGridFS(type="static", id=3030, filename="refused", pointcloud2=sent))
    publisher.publish(TmsdbGridFS(type="dynamic", id=3031, filename="lidar", pointcloud2=sent))
    cloud = lambda: mesh.db(TerrainStaticSrv, "terrain_cloud", type="dynamic").pointcloud2  # noqa: E731
    mesh.until(lambda: cloud() == sent, "stored cloud")


def tasks(mesh: Mesh) -> None:
    added = mesh.db(AddTask, "add_task", task_sequence=TREE)
    assert (added.error_code, added.task_id, added.model_name) == ("", 1, "zx200")
    again = mesh.db(AddTask, "add_task", task_sequence=STORED)
    assert (again.task_id, again.already_stored) == (1, True)
    assert mesh.db(GetTask, "get_task", task_id=1).task.task_sequence == TREE
    (listed,) = mesh.db(ListTasks, "list_tasks").tasks
    assert (listed.description, listed.task_sequence) == ("No Commented.", "")
    for call, code in (
        (mesh.db(AddTask, "add_task", task_sequence="<root>\n<a></root>"), "BAD_TASK"),
        (mesh.db(GetTask, "get_task", task_id=9), "TASK_MISSING"),
        (mesh.db(RemoveTask, "remove_task", task_id=9), "TASK_MISSING"),
    ):
        assert call.error_code == code
        assert call.error_msg
        assert "\n" not in call.error_msg
    assert mesh.db(RemoveTask, "remove_task", task_id=1).error_code == ""


def templates(mesh: Mesh) -> None:
    """Stored over ROS; an import of a running mesh is seen at once."""
    text = TREE.replace("say", "r").replace("a&#10;b", "$r$")
    added = mesh.db(AddTemplate, "add_template", template_name="Dig", task_sequence=text)
    assert (added.error_code, added.model_name, added.already_stored) == ("", "zx200", False)
    assert mesh.db(AddTemplate, "add_template", template_name="Dig", task_sequence=text).already_stored
    other = {"template_name": "Dig", "task_sequence": text.replace("$r$", "$s$")}
    assert mesh.db(AddTemplate, "add_template", **other).error_code == "TEMPLATE_EXISTS"
    assert mesh.db(AddTemplate, "add_template", **other, replace=True).replaced
    assert mesh.db(AddTemplate, "add_template", template_name="No", task_sequence="<root/>").error_code == "BAD_TASK"
    stored = mesh.db(GetTemplate, "get_template", template_name="Dig").stored
    assert (stored.task_sequence, stored.description) == (other["task_sequence"], "Dig.xml")
    assert stored.added_at.sec > 0
    folder = mesh.log.with_name("from")
    folder.mkdir()
    (folder / "Level.xml").write_text(text)
    (folder / "calls.xml").write_text(TREE.replace('ID="X"', 'ID="ExecuteSubtask" subtask_name="Level" r="1"'))
    done = programs.tms(("--site", str(mesh.site.path), "import", str(folder), "--json"), mesh.environment, 60)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["imported"]
    listed = mesh.db(ListTemplates, "list_templates").templates
    assert [(one.template_name, one.task_sequence) for one in listed] == [("Dig", ""), ("Level", "")]
    (task,) = mesh.db(ListTasks, "list_tasks").tasks
    assert task.description == "calls.xml"
    mesh.db(RemoveTask, "remove_task", task_id=task.task_id)
    assert mesh.db(RemoveTemplate, "remove_template", template_name="Dig").error_code == ""
    assert mesh.db(GetTemplate, "get_template", template_name="Dig").error_code == "TEMPLATE_MISSING"


def records(mesh: Mesh) -> None:
    key = {"model_name": "zx200", "record_name": "p"}
    assert mesh.db(SetParameter, "set_parameter", **key, values=VALUES).error_code == "RECORD_MISSING"
    made = mesh.db(SetParameter, "set_parameter", **key, values=VALUES, type="static", source="test", create=True)
    assert (made.error_code, made.created) == ("", True)
    record = mesh.db(GetParameter, "get_parameter", **key).record
    assert {p.name: p.value for p in record.values} == KINDS
    assert (record.type, record.source) == ("static", "test")
    assert record.updated_at.sec > 0
    nan = Parameter(name="d", value=ParameterValue(type=3, double_value=float("nan")))
    refused = mesh.db(SetParameter, "set_parameter", **key, values=[nan])
    assert refused.error_code == "BAD_RECORD"
    assert words(refused.error_msg).startswith("zx200/p.d: nan")
    assert mesh.db(SetParameter, "set_parameter", **key, remove=["i"]).error_code == ""
    (record,) = mesh.db(ListParameters, "list_parameters", model_name="zx200").records
    assert "i" not in {p.name for p in record.values}
    assert mesh.db(RemoveParameter, "remove_parameter", **key).error_code == ""
    assert mesh.db(GetParameter, "get_parameter", **key).error_code == "RECORD_MISSING"


def history(mesh: Mesh) -> None:
    run = Run(
        run_id="r1",
        task_id=4,
        state="RUNNING",
        machines=["zx200"],
        records=["zx200/*"],
        started_at=Time(sec=5, nanosec=7_000_000),
    )
    events = [Event(run_id="r1", number=n, stamp=Time(sec=5 + n), kind="node", values=VALUES) for n in (1, 2, 3)]
    for _ in range(2):
        assert mesh.db(WriteJournal, "write_journal", runs=[run], events=events).error_code == ""
    assert mesh.db(ListRuns, "list_runs").runs == [run]
    assert mesh.db(ListEvents, "list_events", run_id="r1").events == events
    assert mesh.db(ListEvents, "list_events", run_id="r1", after=2).events == events[2:]
    assert mesh.db(ListEvents, "list_events", run_id="none").error_code == "RUN_MISSING"
    static = {"model_name": "zx200", "record_name": "q"}
    mesh.db(SetParameter, "set_parameter", **static, values=VALUES, type="static", create=True)
    assert mesh.db(SetParameter, "set_parameter", **static, values=VALUES).error_code == "STATIC_RECORD"


def cpp_names(mesh: Mesh) -> None:
    mesh.db(AddTask, "add_task", task_sequence=TREE)
    assert mesh.call(TmsdbGetTask, "tms_db_reader_task", task_id=1).task == TREE
    assert mesh.call(TmsdbGetTask, "tms_db_reader_task", task_id=9).task == ""
    value = Parameter(name="x", value=ParameterValue(type=3, double_value=1.5))
    mesh.db(SetParameter, "set_parameter", record_name="BOARD", values=[value], create=True)
    (found,) = mesh.call(TmsdbGetData, "tms_db_param_reader", name="BOARD", flgorparam="flg").tmsdbs
    assert json.loads(found.msg)["x"] == 1.5
    (found,) = mesh.call(TmsdbGetData, "tms_db_param_reader", recordnames=["no", "BOARD"], flgorparam="param").tmsdbs
    assert json.loads(found.msg) == {
        "x": 1.5, "y": [], "z": [], "qx": [], "qy": [], "qz": [], "qw": [], "Release_Count": [],
    }  # fmt: skip


def registration_node(mesh: Mesh) -> None:
    def register(*given: str) -> tuple[int, str, str]:
        words = [sys.executable, "-m", "tms_db.task_generator", "--ros-args"]
        words += [word for one in given for word in ("-p", one)]
        done = subprocess.run(words, env=mesh.environment, capture_output=True, text=True, timeout=LIMIT, check=False)
        return done.returncode, done.stdout, done.stderr

    file = "bt_tree_xml_file_name:=one_loading_cycle"
    assert register(file, "description:=digs once") == (0, "task 2\n", "")
    assert register(f"bt_tree_xml_file_name:={CONFIGS}/tasks/one_loading_cycle.xml")[:2] == (
        0, "task 2 (was stored before)\n",
    )  # fmt: skip
    assert mesh.db(GetTask, "get_task", task_id=2).task.description == "digs once"
    code, out, said = register("bt_tree_xml_file_name:=none")
    assert (code, out) == (1, "")
    assert said.startswith("no file 'none' here")
    assert said.count("\n") == 1


def test_store_away_and_back(bare_mesh: Mesh) -> None:
    mesh = bare_mesh
    mesh.start("tms:db")
    mesh.wait_away()
    away = mesh.db(GetTask, "get_task", task_id=1)
    assert away.error_code == "STORE_DOWN"
    assert "the store does not answer" in words(away.error_msg)
    mesh.start("tms:store")
    mesh.wait_ready()
    assert mesh.db(AddTask, "add_task", task_sequence=TREE).task_id == 1
    arm = Arm(mesh)
    assert arm.readers() == 0, "no run: machines are not heard"
    arm.begin()
    mesh.until(lambda: arm.readers() == 1, "the recorder hears the arm")
    mesh.kill("tms:store")
    lost = unix_time()
    assert mesh.db(GetTask, "get_task", task_id=1).error_code == "STORE_DOWN"
    begin = time.monotonic()
    for _ in range(10):
        assert mesh.db(ListTasks, "list_tasks").error_code == "STORE_DOWN"
    assert time.monotonic() - begin < 12  # known to be away: ten time-outs would take 30 s
    mesh.wait_away()
    arm.end_run()
    ended = unix_time()
    assert mesh.call(TmsdbGetTask, "tms_db_reader_task", task_id=1).task == ""
    mesh.start("tms:store")
    mesh.wait_ready()
    assert mesh.db(GetTask, "get_task", task_id=1).task.task_sequence == TREE
    mesh.until(lambda: any(lost < time < ended for time in arm.recorded()), "what was told meanwhile is stored")
    mesh.until(lambda: arm.readers() == 0, "the recorder has left")


class Arm:
    """A machine's arm and the scheduler's list of runs."""

    def __init__(self, mesh: Mesh) -> None:
        self._mesh, self._run = mesh, "run-1"
        self._topic = f"/zx200/{mesh.site.border('zx200').joint_states}"
        self._joints = mesh.ros.publisher(JointState, self._topic)
        self._runs = mesh.ros.publisher(RunStates, "/tms/runs", latched=True)
        self._names = mesh.site.model_of("zx200").driven

    def begin(self) -> None:
        """Tell, ten times a second, until the mesh ends."""
        self._mesh.ros.every(0.1, self._tell)

    def end_run(self) -> None:
        self._run = ""

    def _tell(self) -> None:
        self._runs.publish(RunStates(runs=[RunState(run_id=self._run)] if self._run else []))
        self._joints.publish(JointState(name=self._names, position=[0.25] * len(self._names)))

    def readers(self) -> int:
        return int(self._mesh.ros.node.count_subscribers(self._topic))

    def recorded(self) -> list[float]:
        """The times [s since 1970] that the database knows."""
        found = self._mesh.db(ReadRecording, "read_recording", machine="zx200", points=20_000)
        assert found.error_code == "" and {one.kind for one in found.series} <= {"joints"}
        assert all(angle == 0.25 for one in found.series for angle in one.values)
        return [time for one in found.series for time in one.times]
