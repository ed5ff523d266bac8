"""Tasks and templates of version 6 of the C++ system: what the check says of each, and what they do with machines.

A template that is run alone gets its words in `$` here, as its task gives them.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import mongomock
import pytest

from tms_db.tasks import Tasks
from tms_machine.goal_inputs import parted
from tms_reason.wire import to_line
from tms_ts import tree_reasons as r
from tms_ts.bt import FAILURE, RUNNING, SUCCESS, Status, check, load
from unit.tms_ts.fakes import FakeFlags, FakeMachines, FakeWorld
from v6_templates import TASKS, known

FILES = sorted(TASKS.glob("*.xml"))
EXPECTED = [json.loads(line) for line in (TASKS / "expected.jsonl").read_text(encoding="utf-8").splitlines()]


@pytest.mark.parametrize("row", EXPECTED, ids=[row["file"] for row in EXPECTED])
def test_what_the_check_says(row: dict[str, Any]) -> None:
    report = check(TASKS / row["file"], templates=known)
    errors = [[error.line, to_line(error.what)] for error in report.errors]
    warnings = [[line, to_line(what)] for line, what in report.warnings]
    assert (report.nodes, errors, warnings) == (row["nodes"], row["errors"], row["warnings"])


def test_every_file_is_expected_and_loads_where_it_gives_its_templates_what_they_need() -> None:
    assert [row["file"] for row in EXPECTED] == [file.name for file in FILES]
    assert len(FILES) == 15
    # It calls a template and gives no values: there the C++ system writes the word none.
    assert [row["file"] for row in EXPECTED if row["errors"]] == ["subtask__Bulldozer__leveling_task.xml"]


def test_a_template_that_nobody_has_is_named() -> None:
    (error,) = check(TASKS / "subtask__CrawlerDump__Release_Task_With_Bull_2.xml").errors
    assert (error.line, error.what) == (7, r.NoTemplate("Release_Subtask_With_Bull"))


def test_a_primitive_that_is_empty_is_an_error_once_its_template_has_its_values() -> None:
    template = (known("leveling_subtask_run_real2") or "").replace("$", "")
    report = check(TASKS / "subtask__Bulldozer__leveling_task.xml", templates=lambda _: template)
    assert [(error.line, error.what) for error in report.errors] == [
        (10, r.NameMissing("LeafNodeBulldozer", "primitive_name"))
    ]


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.name)
def test_its_text_comes_back_from_the_database_as_it_was(file: Path) -> None:
    tasks, text = Tasks(mongomock.MongoClient().db), file.read_text(encoding="utf-8")
    assert tasks.get(tasks.add(text, "", {"zx200"}).task_id).task_sequence == text


class Site:
    """A run of a file whose words in `$` are filled in; seconds go by between ticks."""

    def __init__(self, file: str, values: dict[tuple[str, str], Any] | None = None, **words: str) -> None:
        self.fake = FakeWorld(FakeMachines(lasts=2), flags=FakeFlags(dict(values or {})))
        self.text = (TASKS / f"{file}.xml").read_text(encoding="utf-8")
        for word, value in words.items():
            self.text = self.text.replace(f"${word}$", value)
        self.tree = load(self.text, world=self.fake.world(), templates=known)

    def go(self, seconds: float = 1.0, ticks: int = 200) -> Status:
        status = RUNNING
        while status is RUNNING and ticks > 0:
            self.fake.clock.now += seconds
            status, ticks = self.tree.tick(), ticks - 1
        return status

    @property
    def goals(self) -> list[tuple[str, str, str, dict[str, str | bool]]]:
        return [(goal.machine, goal.subtask, *parted(goal.record)) for goal in self.fake.machines.sent]

    @property
    def records(self) -> list[str]:
        return [record for _, _, record, _ in self.goals]


def test_the_older_ports_of_an_excavator() -> None:
    site = Site("official_registred_tasks__task_id2")
    assert site.go() is SUCCESS
    once = ["initial_pose", "target_excavate_pose", "hold_soil_while_elevating_pose", "hold_soil_while_turning_pose",
            "target_release_pose", "release_angle"]  # fmt: skip
    assert site.records == once * 4
    assert site.goals[1] == ("zx200", "primitive_excavator_excavate_simple", "target_excavate_pose", {})


def test_an_excavator_plans_from_the_end_of_the_plan_before() -> None:
    site = Site(
        "subtask__Excavator__Excavate_combined2", model_name="zx200", excavate1="A", excavate2="B", excavate3="C"
    )
    assert site.go() is SUCCESS
    plan, execute = "primitive_excavator_change_pose_plan", "primitive_excavator_change_pose_execute_from_plan"
    assert site.goals == [
        ("zx200", plan, "A", {}),
        ("zx200", plan, "B", {"previous_target_record_name": "A"}),
        ("zx200", plan, "C", {"previous_target_record_name": "B"}),
        ("zx200", execute, "A,B,C", {}),
    ]


def test_gather() -> None:
    site = Site("subtask__Excavator__Gather")
    assert site.go() is SUCCESS
    assert site.records == ["gather_pose_1", "gather_pose_1", "gather_pose_2", "gather_pose_2"]


def test_a_blade_is_held_for_thirty_seconds() -> None:
    site = Site("subtask__Bulldozer__blade_hold")
    assert site.go(seconds=1.0, ticks=20) is RUNNING
    assert site.goals == [("d37pxi_24", "primitive_bulldozer_blade_control", "blade_up_height", {"blade_hold": True})]
    assert site.go() is SUCCESS
    assert site.goals[1][3] == {}


def test_a_circle_up_and_down() -> None:
    site = Site("subtask__CrawlerDump__navigate_test2")
    assert site.go() is SUCCESS
    assert [inputs for *_, inputs in site.goals] == [{"read_direction": "up"}, {"read_direction": "down"}]


def test_levelling_counts_its_lanes() -> None:
    """The C++ system stops here: its counter is a number, and the expression compares it with a text."""
    words = {"blade_tilt_1": "tilt_1", "blade_tilt_2": "tilt_2", "leveling_time": "5"}
    site = Site("subtask__Bulldozer__leveling_subtask_run_real2", **words)
    assert {type(what) for _, what in site.tree.warnings} == {r.NumberNotText, r.NumberBesideText}
    assert site.go() is SUCCESS
    lanes = [record for lane in (2, 3, 4) for record in ("tilt_2", f"origin_{lane}", f"push_{lane}")]
    assert site.records == ["tilt_1", "origin_1", "push_1", *lanes]


ROAD = [f"372596030000{number}" for number in range(5)]


def road(up: str, at: str, machine: str = "TRUCK") -> dict[tuple[str, str], Any]:
    """Five sections, one behind the other, and the record of the machine, which stands at one of them."""
    values: dict[tuple[str, str], Any] = {(machine, "CURRENT_SECTION"): at, (machine, "UP_DOWN"): up}
    for number, name in enumerate(ROAD):
        for field, other in (("up", number + 1), ("down", number - 1)):
            values[name, f"related_point_{field}_main"] = ROAD[other] if 0 <= other < len(ROAD) else ""
            values[name, f"related_point_{field}_sub"] = ""
        values[name, "label"], values[name, "preferred_direction"] = "main", "up"
    return values


@pytest.mark.parametrize(("way", "start", "end"), [("up", ROAD[0], ROAD[3]), ("down", ROAD[3], ROAD[1])])
def test_a_truck_drives_along_a_road_section_by_section(way: str, start: str, end: str) -> None:
    words = {
        "machine_record_name": "TRUCK",
        "model_name": "mst110cr",
        "start_status": start,
        "terminate_condition": end,
    }
    site = Site("subtask__CrawlerDump__Cruise_Subtask_1", road(way, start), **words)
    assert site.go() is SUCCESS
    sections = ROAD if way == "up" else ROAD[::-1]
    drive = "primitive_crawlerdump_follow_waypoints"
    driven = sections[sections.index(start) : sections.index(end) + 1]
    assert site.goals == [("mst110cr", drive, section, {"read_direction": way}) for section in driven]
    assert site.fake.flags.values["TRUCK", "CURRENT_SECTION"] == end
    assert isinstance(site.fake.flags.values["TRUCK", "CURRENT_SECTION"], str)


def test_a_truck_waits_before_a_section_that_another_one_is_in() -> None:
    words = {
        "machine_record_name": "TRUCK",
        "model_name": "mst110cr",
        "start_status": "none",
        "terminate_condition": ROAD[2],
    }
    values = road("up", ROAD[0]) | {("OTHER", "CURRENT_SECTION"): ROAD[2], ("OTHER", "UP_DOWN"): "up"}
    site = Site("subtask__CrawlerDump__Cruise_Subtask_1", values, **words)
    assert site.go(ticks=20) is RUNNING
    assert site.records == [ROAD[1]]
    site.fake.flags.values["OTHER", "CURRENT_SECTION"] = ROAD[3]
    assert site.go() is SUCCESS
    assert site.records == [ROAD[1], ROAD[2]]


def test_soil_is_released_and_the_bed_comes_down_later() -> None:
    words = {"model_name": "mst110cr", "dump_up_angle": "UP", "dump_down_angle": "DOWN", "time": "5000"}
    site = Site("subtask__CrawlerDump__Release_Subtask", **words)
    assert site.go(ticks=5) is RUNNING
    assert site.records == ["UP"]
    assert site.go() is SUCCESS
    assert site.records == ["UP", "DOWN"]


def test_a_reader_of_an_array_fails_as_in_the_cpp_system() -> None:
    words = {"model_name": "mst110cr", "release_area_data": "AREA", "block_point": "block_0", "stop_point": "stop_0",
             "dump_up_angle": "UP", "dump_down_angle": "DOWN", "time": "5000"}  # fmt: skip
    values = {("AREA", "RELEACED_BLOCK"): ["block_1"], ("AREA", "LATEST_RELEACED_BLOCK"): ""}
    site = Site("subtask__CrawlerDump__Release_Subtask_With_Bull", values, **words)
    assert site.go() is FAILURE
    assert site.goals == []


@pytest.mark.parametrize(("loaded", "end", "driven"), [(True, SUCCESS, 4), (False, FAILURE, 2)])
def test_loading(loaded: bool, end: Status, driven: int) -> None:
    words = {"model_name": "mst110cr", "loading_point": "L", "swing_angle_for_loading": "S",
             "arrival_flg_record_name": "F", "loaded_flg_record_name": "now", "swing_angle_for_runing": "R",
             "after_loading_point": "A"}  # fmt: skip
    site = Site("subtask__CrawlerDump__Loading_Subtask_With_Run2", {("loaded_flg", "now"): loaded}, **words)
    assert site.go() is end
    assert site.records == ["L", "S", "R", "A"][:driven]
    assert site.goals[1][3] == {}  # an empty read_direction is none
    assert site.fake.flags.values["F", "arrival_flg"] is not loaded


def test_a_task_digs_releases_and_moves_on() -> None:
    site = Site("subtask__Excavator__ExcavateReleaseMove")
    assert site.go() is SUCCESS
    part = [f"target_{what}_pose_{number}" for what in ("excavate", "release") for number in (1, 2, 3)]
    lists = [",".join(part[:3]), ",".join(part[3:])]
    once = [*part[:3], lists[0], *part[3:], lists[1]]
    assert site.records == [*once, "excavater_point1", *once, "excavater_point2"]
    assert {machine for machine, *_ in site.goals} == {"zx200"}


def test_a_truck_drives_up_releases_and_drives_back_again_and_again() -> None:
    site = Site("subtask__CrawlerDump__Cruise_and_Release_Task2_nav")
    assert site.go(seconds=10.0, ticks=30) is RUNNING
    once = [ROAD[4], "RELEASE_ANGLE_UP", "RELEASE_ANGLE_DOWN", ROAD[0]]
    assert site.records[:8] == once * 2


def test_a_truck_is_loaded_drives_up_section_by_section_releases_and_drives_back() -> None:
    values = road("up", ROAD[0], machine="SAMPLE_BLACKBOARD_mst110cr") | {("", "loaded_flg"): True}
    site = Site("subtask__CrawlerDump__Load_and_Cruise_and_Release_Task", values)
    assert site.go(seconds=10.0, ticks=60) is RUNNING
    turn = [("", ""), ("", "")]  # it gives no record of an angle
    release = [("RELEASE_ANGLE_UP", ""), ("RELEASE_ANGLE_DOWN", "")]
    once = [*turn, *((one, "up") for one in ROAD), *release, *((one, "down") for one in ROAD[::-1]), *turn]
    assert [(record, inputs.get("read_direction", "")) for *_, record, inputs in site.goals][: len(once)] == once
