"""What stands around a machine that drives: machines where they were told to be, and blocked areas of the database."""

import math
from types import SimpleNamespace
from typing import Any

import pytest
import structlog
from tms_msg_db.msg import Record
from tms_msg_db.srv import GetParameter

from tms_config.clock import monotonic
from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_control.ground import Body
from tms_control.path import Pose
from tms_control.reasons import BlockedArea, MachineThere
from tms_control.roads import Roads
from tms_machine.drift import drift
from tms_machine.frames import FramePose
from tms_machine.reasons import BadRecord
from tms_machine.values import Value, to_parameters
from tms_mc.blocked_areas import RECORD, areas
from tms_mc.reasons import AreaUnfit
from tms_mc.records import LIMIT, SERVICE
from tms_mc.surroundings import Surroundings
from tms_reason.errors import RosError, SubtaskFailed
from tms_reason.wire import to_line
from tms_ros.reasons import NoAnswer

TRUCK = parse(CONFIGS / "machines" / "ic120.yaml", MachineModel)
PIT = [10.0, 0.0, 20.0, 0.0, 20.0, 5.0]
HERE = Pose(0.0, 0.0, 0.0)
CORNERS = ((10.0, 0.0), (20.0, 0.0), (20.0, 5.0))


def test_an_area_is_its_corners_in_turn() -> None:
    assert areas({"pit": PIT, "hole": [0, 0, 1, 0, 1, 1]}) == [
        Body(BlockedArea("pit"), CORNERS), Body(BlockedArea("hole"), ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0)))
    ]  # fmt: skip


@pytest.mark.parametrize(
    "value",
    [[], PIT[:4], PIT[:5], [*PIT[:5], math.nan], [*PIT[:5], math.inf], [1.0] * 102, "pit", 3.0, ["a"] * 6, [True] * 6],
)
def test_an_area_that_makes_no_sense_is_refused_by_its_name(value: Value) -> None:
    with pytest.raises(SubtaskFailed) as caught:
        areas({"pit": value})
    assert caught.value.reason == BadRecord(RECORD, AreaUnfit("pit", 3, 50))


class Site:
    """A site of one truck besides ours, and its database."""

    def __init__(self) -> None:
        self.there, self.error = True, ""
        self.answers = True
        self.values: dict[str, Any] = {"pit": PIT}
        self.sections: dict[tuple[str, str], dict[str, Any]] = {}  # by machine and record: further records
        self.places: dict[str, FramePose] = {}

    def around(self, monkeypatch: pytest.MonkeyPatch) -> Surroundings:
        places = SimpleNamespace(place=self.places.get, take=set)
        monkeypatch.setattr("tms_mc.surroundings.Places", lambda _ros, borders: self._of(borders, places))
        ros = SimpleNamespace(
            prepare=lambda *_: None, has_service=lambda *_: self.there, call=self._call,
            poll_in_thread=lambda *_: None,
        )  # fmt: skip
        machines = dict.fromkeys(("ic120_1", "ic120_2"))
        site = SimpleNamespace(
            area_files=[], file=SimpleNamespace(machines=machines), model_of=lambda _: TRUCK, border=lambda _: None
        )
        log = structlog.stdlib.get_logger("test")
        return Surroundings(SimpleNamespace(ros=ros, site=site, machine="ic120_1", log=log))  # type: ignore[arg-type]

    @staticmethod
    def _of(borders: dict[str, Any], places: Any) -> Any:
        assert list(borders) == ["ic120_2"]
        return places

    def _call(self, _: Any, service: str, request: GetParameter.Request, limit: float) -> GetParameter.Response:
        assert (service, limit) == (SERVICE, LIMIT)
        if not self.answers:
            raise RosError(NoAnswer("tms:db", service, limit))
        if (request.model_name, request.record_name) != ("", RECORD):
            return self._section(self.sections.get((request.model_name, request.record_name)))
        message = to_line(AreaUnfit("pit", 3, 50))
        record = Record(values=to_parameters(self.values))
        return GetParameter.Response(error_code=self.error, error_msg=message if self.error else "", record=record)

    @staticmethod
    def _section(values: dict[str, Any] | None) -> GetParameter.Response:
        if values is None:
            return GetParameter.Response(error_code="RECORD_MISSING")
        return GetParameter.Response(record=Record(values=to_parameters(values)))


def test_areas_are_read_and_machines_stand_where_they_were_told_to_be(monkeypatch: pytest.MonkeyPatch) -> None:
    site = Site()
    around = site.around(monkeypatch)
    assert around.ground().bodies == ()
    around.read(HERE)
    site.places["ic120_2"] = FramePose(30.0, 5.0, math.pi, monotonic())
    vessel, cab, pit = around.ground().bodies
    assert pit == Body(BlockedArea("pit"), CORNERS)
    assert {vessel.name, cab.name} == {MachineThere("ic120_2")} and vessel.growth == 0.0
    assert max(x for x, _ in vessel.corners) == pytest.approx(33.6)


def test_a_machine_that_was_not_heard_for_long_is_grown(monkeypatch: pytest.MonkeyPatch) -> None:
    site = Site()
    site.places["ic120_2"] = FramePose(30.0, 5.0, 0.0, monotonic() - 20.0)
    vessel, _ = site.around(monkeypatch).ground().bodies
    assert vessel.growth == drift(TRUCK, 20.0) > 1.0


@pytest.mark.parametrize("lost", ["there", "answers", "error"])
def test_without_the_database_what_was_read_last_holds(lost: str, monkeypatch: pytest.MonkeyPatch) -> None:
    site = Site()
    around = site.around(monkeypatch)
    around.read(HERE)
    setattr(site, lost, "STORE_DOWN" if lost == "error" else False)
    site.values = {}
    around.read(HERE)
    assert len(around.ground().bodies) == 1


def test_without_a_record_nothing_is_blocked(monkeypatch: pytest.MonkeyPatch) -> None:
    site = Site()
    around = site.around(monkeypatch)
    around.read(HERE)
    site.error, site.values = "RECORD_MISSING", {}
    around.read(HERE)
    assert around.ground().bodies == ()


def test_a_record_that_is_too_old_refuses(monkeypatch: pytest.MonkeyPatch) -> None:
    site = Site()
    site.error = "STALE_RECORD"
    with pytest.raises(SubtaskFailed) as caught:
        site.around(monkeypatch).read(HERE)
    assert caught.value.reason == AreaUnfit("pit", 3, 50)  # the reason of the answer


def test_roads_are_read_of_the_machine_s_own_sections_before_shared_ones(monkeypatch: pytest.MonkeyPatch) -> None:
    site = Site()
    site.sections = {
        ("", "roads"): {"haul": ["s0", "s1"]}, ("", "s0"): {"x": 1.0, "y": 2.0}, ("", "s1"): {"x": 5.0, "y": 5.0},
        ("ic120_1", "s1"): {"x": 9.0, "y": 2.0},
    }  # fmt: skip
    around = site.around(monkeypatch)
    around.read(HERE)
    assert around.roads == Roads((((1.0, 2.0), (9.0, 2.0)),))
    site.sections = {}
    around.read(HERE)
    assert around.roads == Roads()
