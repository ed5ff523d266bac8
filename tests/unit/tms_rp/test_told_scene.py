"""The scene records are read for each plan; while the database is away, those that were read last hold."""

from types import SimpleNamespace
from typing import Any

import pytest
import structlog
from builtin_interfaces.msg import Time
from tms_msg_db.msg import Record
from tms_msg_db.srv import ListParameters

from tms_config.clock import unix_time
from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_machine.values import to_parameters
from tms_reason.errors import RosError, SubtaskFailed
from tms_ros.reasons import NoAnswer
from tms_rp.reasons import SceneRecordOld, Told
from tms_rp.told_scene import LIMIT, SERVICE, ToldScene

WALL = {"x": 6.0, "y": 0.0, "z": 1.0, "dimensions": [1.0, 1.0, 2.0]}


def record(name: str, age: float = 0.0, max_age: float = 0.0) -> Record:
    at = Time(sec=int(unix_time() - age))
    return Record(record_name=name, type="dynamic", updated_at=at, max_age=max_age, values=to_parameters(WALL))


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
    assert [one.name for one in told.obstacles()] == [Told("collision_object_wall")]


def test_a_record_that_is_gone_stands_in_nobodys_way() -> None:
    database = Database(record("collision_object_wall"))
    told = database.told()
    assert told.obstacles()
    database.records = []
    assert told.obstacles() == []


@pytest.mark.parametrize("lost", ["there", "answers"])
def test_without_the_database_what_was_told_last_holds(lost: str) -> None:
    database = Database(record("collision_object_wall"))
    told = database.told()
    told.obstacles()
    setattr(database, lost, False)
    database.records = []
    assert [one.name for one in told.obstacles()] == [Told("collision_object_wall")]


def test_a_record_gets_older() -> None:
    with pytest.raises(SubtaskFailed) as caught:
        Database(record("collision_object_wall", age=9.0, max_age=5.0)).told().obstacles()
    assert isinstance(caught.value.reason, SceneRecordOld)
