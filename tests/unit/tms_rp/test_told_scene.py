"""The scene records are read for each plan; while the database is away, those that were read last hold."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import structlog
import structlog.testing
from builtin_interfaces.msg import Time
from tms_msg_db.msg import Record
from tms_msg_db.srv import ListParameters

from tms_config.clock import unix_time
from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_machine.reasons import BadRecord
from tms_machine.values import to_parameters
from tms_reason.errors import RosError, SubtaskFailed
from tms_reason.reason import Reason
from tms_ros.reasons import NoAnswer
from tms_rp.reasons import MeshAsFile, MeshSimplified, NamesUnfit, NoSuchObstacle, PaddingUnfit, SceneRecordOld, Told
from tms_rp.scene_view import Area
from tms_rp.told_mesh import surface
from tms_rp.told_scene import LIMIT, SERVICE, ToldScene

HEAP: dict[str, Any] = {"x": 6.0, "y": 0.0, "z": 0.0, "vertices": [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0],
                        "triangles": [0, 1, 2]}  # fmt: skip
WALL = {"x": 6.0, "y": 0.0, "z": 1.0, "dimensions": [1.0, 1.0, 2.0]}


def record(name: str, age: float = 0.0, max_age: float = 0.0, **values: Any) -> Record:
    at = Time(sec=int(unix_time() - age))
    told = to_parameters(values or WALL)
    return Record(record_name=name, type="dynamic", updated_at=at, max_age=max_age, values=told)


class Database:
    """Answers as the database would."""

    def __init__(self, *records: Record) -> None:
        self.there, self.answers, self.records = True, True, list(records)

    def told(self) -> ToldScene:
        ros = SimpleNamespace(prepare=lambda *_: None, has_service=lambda *_: self.there, call=self._call)
        model = parse(CONFIGS / "machines" / "zx200.yaml", MachineModel)
        site = SimpleNamespace(
            model_of=lambda _: model, file=SimpleNamespace(machines={"zx200": SimpleNamespace(model="zx200")})
        )
        app: Any = SimpleNamespace(ros=ros, site=site, machine="zx200", log=structlog.stdlib.get_logger("test"))
        return ToldScene(app)

    def _call(self, _: Any, service: str, request: ListParameters.Request, limit: float) -> ListParameters.Response:
        assert (service, request.model_name, limit) == (SERVICE, "zx200", LIMIT)
        if not self.answers:
            raise RosError(NoAnswer("tms:db", service, limit))
        return ListParameters.Response(records=self.records)


def test_records_of_the_scene_become_obstacles_and_others_do_not() -> None:
    told = Database(record("collision_object_wall"), record("initial_pose")).told()
    assert [one.name for one in told.scene().obstacles] == [Told("collision_object_wall")]


def test_a_record_that_is_gone_stands_in_nobodys_way() -> None:
    database = Database(record("collision_object_wall"))
    told = database.told()
    assert told.scene().obstacles
    database.records = []
    assert told.scene().obstacles == ()


@pytest.mark.parametrize("lost", ["there", "answers"])
def test_without_the_database_what_was_told_last_holds(lost: str) -> None:
    database = Database(record("collision_object_wall"))
    told = database.told()
    told.scene()
    setattr(database, lost, False)
    database.records = []
    assert [one.name for one in told.scene().obstacles] == [Told("collision_object_wall")]


def test_a_record_gets_older() -> None:
    with pytest.raises(SubtaskFailed) as caught:
        Database(record("collision_object_wall", age=9.0, max_age=5.0)).told().scene()
    assert isinstance(caught.value.reason, SceneRecordOld)


def test_a_root_names_more_obstacles_and_pads_links() -> None:
    root = record("collision_objects_site", collision_object_record_names=["post"], link_padding={"bucket_link": 0.32})
    other = record("other", link_padding={"bucket_link": 0.1, "arm_link": 0.2})
    scene = Database(root, other, record("post"), record("collision_object_wall"), record("pose")).told().scene()
    assert [one.name for one in scene.obstacles] == [Told("post"), Told("collision_object_wall")]
    assert dict(scene.padding) == pytest.approx({"bucket_link": 0.35, "arm_link": 0.2})


@pytest.mark.parametrize(
    ("values", "why"),
    [
        ({"collision_object_record_names": ["nobody"]}, NoSuchObstacle("nobody")),
        ({"collision_object_record_names": [1, 2]}, NamesUnfit("collision_object_record_names")),
        ({"link_padding": {"bucket_link": -0.1}}, PaddingUnfit("bucket_link", 2.0)),
        ({"link_padding": {"bucket_link": 2.5}}, PaddingUnfit("bucket_link", 2.0)),
        ({"link_padding": {"wing": 0.1}}, PaddingUnfit("wing", 2.0)),
        ({"link_padding": [0.1]}, PaddingUnfit("", 2.0)),
    ],
)
def test_a_root_that_makes_no_sense_refuses(values: dict[str, Any], why: Reason) -> None:
    with pytest.raises(SubtaskFailed) as caught:
        Database(record("root", **values)).told().scene()
    assert caught.value.reason == BadRecord("root", why)


def test_a_surface_is_made_once_for_each_change(monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[str] = []

    def counted(name: str, values: Any) -> Any:
        made.append(name)
        return surface(name, values)

    monkeypatch.setattr("tms_rp.told_scene.surface", counted)
    database = Database(record("collision_object_heap", **HEAP))
    told = database.told()
    for _ in range(3):
        (heap,) = told.scene().obstacles
        assert heap.mesh is not None and len(heap.mesh.faces) == 1
    assert made == ["collision_object_heap"]
    database.records = [record("collision_object_heap", age=5.0, **HEAP)]
    told.scene()
    assert len(made) == 2


@pytest.mark.parametrize("name", ["collision_object_heap", "collision_object_zx200"])
def test_a_surface_that_is_stored_as_a_file_refuses(name: str) -> None:
    told = record(name, x=6.0, y=0.0, z=0.0)
    told.type = "mesh"
    with pytest.raises(SubtaskFailed) as caught:
        Database(told).told().scene()
    assert caught.value.reason == BadRecord(name, MeshAsFile())
    told.values = to_parameters(HEAP)
    assert Database(told).told().scene().obstacles


def test_a_surface_that_is_simplified_is_told() -> None:
    rng = np.random.default_rng(1)
    vertices = rng.uniform(0, 5, (3000, 3)).ravel().tolist()
    many = {**HEAP, "vertices": vertices, "triangles": list(range(3000)) * 11}
    with structlog.testing.capture_logs() as logs:
        (heap,) = Database(record("collision_object_heap", **many)).told().scene().obstacles
    (said,) = [one["reason"] for one in logs if one["event"] == "mesh_simplified"]
    assert heap.mesh is not None
    assert said == MeshSimplified("collision_object_heap", 11000, len(heap.mesh.faces), heap.mesh.off)


def test_areas_of_records_are_shown_only() -> None:
    waypoints = [{"type": "area", "data": {"x": 5.0, "y": 0.0, "z": 0.0, "size_x": 2.0, "size_y": 1.0, "size_z": 0.5}}]
    points = [{"x": 6.0, "y": 1.0, "z": -0.5, "theta_w": 1.0}, {"x": "here"}]
    database = Database(record("dig", waypoints=waypoints), record("pits", excavatable_points=points), record("pose"))
    told = database.told()
    assert told.scene().obstacles == ()
    assert told.areas() == [
        Area("dig", (5.0, 0.0, 0.0), (2.0, 1.0, 0.5)),
        Area("pits", (6.0, 1.0, -0.5), (0.0, 0.0, 0.0)),
    ]
