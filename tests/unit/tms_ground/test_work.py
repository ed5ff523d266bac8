"""`tms:ground` counts work: what machines, gateways and the scheduler publish becomes cycles in the database."""

import re
from collections.abc import Callable, Mapping
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
import structlog
from builtin_interfaces.msg import Time
from geometry_msgs.msg import TransformStamped
from prometheus_client import REGISTRY
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage
from tms_msg_db.srv import WriteMachineStates
from tms_msg_rc.msg import MachineState
from tms_msg_ts.msg import RunState, RunStates

from conftest import PROJECT
from earth_rig import ABOVE, HOLD, OPEN, Arm, dig_poses, moved
from earth_rig import NAMES as JOINTS
from tms_config.config import load_site
from tms_db import messages
from tms_ground import node
from tms_ground.reasons import GroundAway, GroundDamaged, GroundGone, WorkLost
from tms_reason.errors import RosError
from tms_reason.reason import Foreign
from tms_work.cycle import Cycle

SITE = """
name: t
domain: 43
services: {{db: {{}}}}
machines: {{zx200: {{model: zx200}}, ic120: {{model: ic120}}}}
ground: {{area: [-12, -12, 12, 12]}}
sim: {{speed: {speed}}}
"""
BEGIN = 1.8e9  # s since 1970
BACK = OPEN._replace(swing=-1.5)
BUCKET = [*dig_poses(), ABOVE, *[OPEN] * 12, BACK]


class Pc:
    """A PC with its disk and its clock; `start` begins the process anew, as after kill -9."""

    def __init__(self, folder: Path, monkeypatch: pytest.MonkeyPatch, speed: float = 1.0) -> None:
        monkeypatch.setenv("TMS_STATE", str(folder / "state"))
        monkeypatch.setattr(node, "monotonic", lambda: self.now)
        monkeypatch.setattr(node, "unix_time", lambda: BEGIN + self.now)
        self.site = folder / "site.yaml"
        self.site.write_text(SITE.format(speed=speed))
        self.now, self.speed = 100.0, speed
        self.stored: dict[tuple[str, str, int], Cycle] = {}
        self.away = False
        self.start()

    def start(self) -> None:
        self.waiting: dict[str, list[Any]] = {}
        self.steps: dict[str, Callable[[], None]] = {}
        self.heard: dict[str, Callable[[Any], None]] = {}
        ros = SimpleNamespace(
            sample=lambda _, topic, *__: lambda: self.waiting.pop(topic, []),
            subscribe=lambda _, topic, hear, **__: self.heard.update({topic: hear}),
            publisher=lambda *_, **__: SimpleNamespace(publish=lambda _: None),
            poll_in_thread=lambda _, step, name: self.steps.update({name: step}),
            call=self.call,
            now=lambda: Time(sec=int(self.now)),
            offer_slow=lambda *_: None, prepare=lambda *_: None, has_service=lambda *_: False,
        )  # fmt: skip
        app: Any = SimpleNamespace(
            site=load_site(str(self.site)), ros=ros, log=structlog.stdlib.get_logger("test"),
            on_stop=lambda _: None, ready_when=lambda _: None,
        )  # fmt: skip
        self.state = app.site.state
        self.bases = {name: app.site.border(name).base_frame for name in app.site.file.machines}
        node.start(app)
        self.run("r1")
        for machine in ("zx200", "ic120"):
            self.gateway(machine)

    def call(self, _: Any, __: str, request: Any) -> Any:
        if self.away:
            raise RosError(Foreign("no answer"))
        for one in map(messages.cycle, request.states):
            self.stored[one.run_id, one.machine, one.number] = one
        return WriteMachineStates.Response()

    def run(self, run: str) -> None:
        runs = [RunState(run_id=run, machines=["zx200", "ic120"])] if run else []
        self.heard["/tms/runs"](RunStates(runs=runs))

    def gateway(self, machine: str, **state: Any) -> None:
        self.heard[f"/{machine}/rc/state"](MachineState(machine=machine, **{"moving": True} | state))

    def tell(self, machine: str, angles: Mapping[str, float], x: float = 0.0) -> None:
        base = TransformStamped(child_frame_id=self.bases[machine])
        base.header.frame_id, base.transform.rotation.w, base.transform.translation.x = "map", 1.0, x
        self.waiting.setdefault("/tf", []).append(TFMessage(transforms=[base]))
        joints = JointState(name=list(angles), position=list(angles.values()))
        self.waiting[f"/{machine}/joint_states"] = [joints]

    @property
    def ground(self) -> Path:
        return self.state / "ground.npz"

    def load(self, machine: str) -> float:
        found = REGISTRY.get_sample_value("tms_ground_load_cubic_metres", {"machine": machine})
        assert found is not None
        return found

    def look(self) -> None:
        self.steps["ground"]()
        self.now += 0.04 / self.speed

    def dig(self, poses: list[Arm], tilt: float = 0.0) -> None:
        """The excavator goes through poses beside the carrier."""
        for _, pose in moved(poses, rate=25.0):
            self.tell("zx200", dict(zip(JOINTS, pose, strict=True)))
            self.tell("ic120", {"vessel_pin_joint": tilt}, x=6.5)
            self.look()

    def tip(self) -> None:
        for k in range(320):
            self.tell("ic120", {"vessel_pin_joint": -min(1.0, k / 50)}, x=6.5)
            self.look()

    def cycles(self, machine: str) -> list[Cycle]:
        self.steps["cycles"]()
        return sorted((one for one in self.stored.values() if one.machine == machine), key=lambda one: one.number)


@pytest.fixture
def pc(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Pc:
    return Pc(tmp_path, monkeypatch)


def test_a_bucket_and_a_load_are_counted(pc: Pc) -> None:
    begun = pc.now
    pc.dig(BUCKET)
    (dug,) = pc.cycles("zx200")
    assert (dug.run_id, dug.number, dug.kind, dug.into, dug.soil) == ("r1", 1, "dig", "ic120", "earth")
    assert 0.5 < dug.loose < 0.9 and dug.loose == pytest.approx(1.28 * dug.bank, rel=0.01)
    assert dug.fill is not None and 0.5 < dug.fill < 1.0 and not dug.measured
    assert {"dig", "swing_loaded", "dump"} <= dug.parts.keys() <= {"dig", "swing_loaded", "dump", "swing_back"}
    assert BEGIN + begun <= dug.begun_at.timestamp() < dug.ended_at.timestamp() <= BEGIN + pc.now
    pc.tip()
    (hauled,) = pc.cycles("ic120")
    assert hauled.kind == "haul" and hauled.buckets == 1 and hauled.loose == pytest.approx(dug.loose, rel=0.1)


def test_nothing_counts_without_a_run_and_a_new_run_counts_from_one(pc: Pc) -> None:
    pc.run("")
    pc.dig(BUCKET)
    assert pc.cycles("zx200") == []
    for run in ("r2", "r3"):
        pc.run(run)
        pc.dig([BACK, *dig_poses(-1.2)[2:], ABOVE, *[OPEN] * 12, BACK])
    assert [(one.run_id, one.number) for one in pc.cycles("zx200")] == [("r2", 1), ("r3", 1)]


def test_a_cycle_that_ends_with_its_run_is_kept_though_the_ground_rests(pc: Pc) -> None:
    pc.dig([*dig_poses(), ABOVE, ABOVE._replace(bucket=1.3), *[ABOVE] * 60])  # a part of it is out
    pc.steps["ground_file"]()
    assert pc.cycles("zx200") == []
    pc.run("")
    pc.dig([ABOVE] * 20)
    (dug,) = pc.cycles("zx200")
    assert 0.1 < dug.loose < 0.7


def test_finished_cycles_are_metrics(pc: Pc) -> None:
    labels = {"machine": "zx200", "kind": "dig"}
    names = ("cycles", "moved_bank_cubic_metres", "moved_loose_cubic_metres", "moved_kilograms", "cycle_fill_ratio")

    def values() -> list[float]:
        found = [REGISTRY.get_sample_value(f"tms_ground_{name}_total", labels) for name in names]
        part = REGISTRY.get_sample_value("tms_ground_cycle_part_seconds_total", {**labels, "part": "dig"})
        return [value for value in (*found, part) if value is not None]  # all are there from the start

    before = values()
    pc.dig(BUCKET)
    (dug,) = pc.cycles("zx200")
    expected = (1, dug.bank, dug.loose, dug.mass, dug.fill, dug.parts["dig"])
    assert [b - a for a, b in zip(before, values(), strict=True)] == pytest.approx(expected)


def test_boards_and_alerts_ask_for_metrics_that_are_there(pc: Pc) -> None:
    there = {name for metric in REGISTRY.collect() for name in (metric.name, f"{metric.name}_total")}
    files = [PROJECT / "deploy/prometheus/rules.yml", PROJECT / "deploy/grafana/dashboards/tms-work.json"]
    asked = {name for file in files for name in re.findall(r"\btms_ground_\w+", file.read_text(encoding="utf-8"))}
    assert len(asked) > 8 and asked <= there


def test_a_stop_is_told_by_the_gateway(pc: Pc) -> None:
    up = [*dig_poses(), ABOVE]
    pc.dig(up)
    pc.gateway("zx200", moving=False, latch="SOFTWARE_STOP")
    pc.dig([ABOVE] * 81)  # 6.4 s
    pc.gateway("zx200")
    pc.dig([ABOVE, *[OPEN] * 12, BACK])
    (dug,) = pc.cycles("zx200")
    assert dug.parts["stopped"] == pytest.approx(6.4, abs=0.3)


def test_waiting_is_told_by_the_gateway(pc: Pc) -> None:
    side = ABOVE._replace(swing=-0.9)
    pc.dig([*dig_poses(), side])
    pc.gateway("zx200", moving=False)
    pc.dig([side] * 101)  # 8 s
    pc.gateway("zx200")
    pc.dig([side, ABOVE, *[OPEN] * 12, BACK])
    (dug,) = pc.cycles("zx200")
    assert dug.parts["wait_for_truck"] == pytest.approx(8.0, abs=0.3)


def test_machines_that_live_ten_times_as_fast_take_their_own_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "a").mkdir()
    slow, fast = Pc(tmp_path, monkeypatch), None
    slow.dig(BUCKET)
    (one,) = slow.cycles("zx200")
    fast = Pc(tmp_path / "a", monkeypatch, speed=10.0)
    fast.dig(BUCKET)
    (two,) = fast.cycles("zx200")
    assert two.loose == pytest.approx(one.loose, rel=0.03) and two.seconds == pytest.approx(one.seconds, abs=0.5)
    assert two.ended_at.timestamp() == pytest.approx(BEGIN + 100 + one.seconds / 10, abs=0.5)


def test_a_crash_after_the_file_and_before_the_database(pc: Pc) -> None:
    pc.away = True
    pc.dig(BUCKET)
    assert pc.cycles("zx200") == []
    pc.start()
    pc.away = False
    assert [one.number for one in pc.cycles("zx200")] == [1]
    pc.dig([BACK, *dig_poses(-1.2)[2:], ABOVE, *[OPEN] * 12, BACK])
    assert [one.number for one in pc.cycles("zx200")] == [1, 2]


def test_a_crash_after_the_database_counts_nothing_twice(pc: Pc) -> None:
    pc.dig(BUCKET)
    (first,) = pc.cycles("zx200")
    pc.start()
    assert pc.cycles("zx200") == [first]
    pc.dig([BACK, *dig_poses(-1.2)[2:], ABOVE, *[OPEN] * 12, BACK])
    assert [one.number for one in pc.cycles("zx200")] == [1, 2] and pc.cycles("zx200")[0] == first


def test_a_crash_with_a_full_bucket(pc: Pc) -> None:
    """A bucket is kept when it has been filled, so that what it holds does not go back to the ground."""
    pc.dig([*dig_poses(), Arm(-0.6, *HOLD)])
    assert pc.cycles("zx200") == []
    pc.dig([Arm(-0.6, *HOLD), ABOVE])
    pc.start()
    pc.dig([ABOVE, *[OPEN] * 12, BACK])
    (dug,) = pc.cycles("zx200")
    assert 0.5 < dug.loose < 0.9 and dug.number == 1


def test_a_crash_after_an_old_file_takes_up_the_soil_that_it_knows(pc: Pc) -> None:
    """The file knows a full bucket; the cycle that was made of it was neither kept nor sent."""
    pc.dig([*dig_poses(), ABOVE])
    pc.steps["ground_file"]()
    pc.dig([ABOVE, *[OPEN] * 12, BACK])
    pc.start()
    pc.dig([BACK] * 40)
    assert [one.number for one in pc.cycles("zx200")] == [1], "what the bucket held when it was kept counts once"


def test_a_full_disk_sends_nothing_that_a_restart_would_not_know(pc: Pc, monkeypatch: pytest.MonkeyPatch) -> None:
    with monkeypatch.context() as disk:
        disk.setattr("tms_runtime.durable.replace", full)
        pc.dig(BUCKET)
        assert pc.cycles("zx200") == []
    assert [one.number for one in pc.cycles("zx200")] == [1]


def test_work_goes_on_though_the_ground_begins_anew(pc: Pc) -> None:
    """Cycles that wait are sent, a load that the new ground does not know makes none, and numbers go on."""
    pc.away = True
    pc.dig([*BUCKET, *dig_poses(-1.2)[2:], Arm(-0.6, *HOLD)])
    assert pc.cycles("zx200") == []
    pc.site.write_text(pc.site.read_text().replace("ground: {", "ground: {level: -2.5, "))
    pc.start()
    pc.away = False
    pc.dig([Arm(-0.6, *HOLD), ABOVE, *[OPEN] * 12, BACK])
    assert [one.number for one in pc.cycles("zx200")] == [1]
    pc.dig([BACK, *dig_poses(-0.9)[2:], ABOVE, *[OPEN] * 12, BACK])
    assert [one.number for one in pc.cycles("zx200")] == [1, 2]


def test_work_of_another_release_begins_anew_and_the_ground_stays(pc: Pc, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tms_ground.work.Work.state", lambda _: '{"zx200": {"other": 1}}')
    pc.dig([*dig_poses(), ABOVE])
    pc.steps["ground_file"]()
    with structlog.testing.capture_logs() as logs:
        pc.start()
    assert [one["event"] for one in logs] == ["ground_goes_on", "work_begins_anew"]


def again(pc: Pc, turn: float) -> list[int]:
    """Another bucket; the numbers of all that the database knows."""
    pc.dig([BACK, *dig_poses(turn)[2:], ABOVE, *[OPEN] * 12, BACK])
    return [one.number for one in pc.cycles("zx200")]


def reasons(pc: Pc) -> list[type]:
    """Why the next start does not go on as if nothing had happened."""
    with structlog.testing.capture_logs() as logs:
        pc.start()
    return [type(one["reason"]) for one in logs if "reason" in one]


@pytest.mark.parametrize("damage", [lambda file: file.write_bytes(file.read_bytes()[:2000]), Path.unlink])
def test_numbers_go_on_though_the_ground_cannot_be_read(pc: Pc, damage: Callable[[Path], None]) -> None:
    """What was sent stays as it is, what waits is sent, and each cycle has a number of its own."""
    pc.dig(BUCKET)
    (first,) = pc.cycles("zx200")
    pc.away = True
    assert again(pc, -1.2) == [1]
    damage(pc.ground)
    assert reasons(pc) in ([GroundDamaged], [GroundGone])
    pc.away = False
    assert [one.number for one in pc.cycles("zx200")] == [1, 2] and pc.cycles("zx200")[0] == first
    assert again(pc, -0.9) == [1, 2, 3]
    assert reasons(pc)[:1] == [GroundAway], "it goes on with the next file"
    assert again(pc, -0.7) == [1, 2, 3, 4]


def test_numbers_come_from_the_clock_where_no_file_can_be_read(pc: Pc) -> None:
    pc.dig(BUCKET)
    (first,) = pc.cycles("zx200")
    for file in (pc.ground, pc.ground.with_name("work.json")):
        file.write_bytes(file.read_bytes()[:20])
    assert reasons(pc) == [GroundDamaged, WorkLost]
    begun = int(BEGIN + pc.now)
    assert again(pc, -1.2) == [1, begun] and pc.cycles("zx200")[0] == first
    pc.start()
    assert again(pc, -0.9) == [1, begun, begun + 1]


def test_a_crash_in_the_middle_of_a_dig_loses_nothing(pc: Pc) -> None:
    """The file was written before the dig; what was told since is in the journal."""
    pc.dig([OPEN, BACK])
    pc.steps["ground_file"]()
    pc.dig([*dig_poses(now=BACK), Arm(-0.6, *HOLD)])
    held = pc.load("zx200")
    assert held > 0.5
    pc.start()
    pc.look()
    assert pc.load("zx200") == pytest.approx(held, rel=1e-9)
    pc.dig([Arm(-0.6, *HOLD), ABOVE, *[OPEN] * 12, BACK])
    (dug,) = pc.cycles("zx200")
    assert dug.loose == pytest.approx(held, rel=0.03) and dug.buckets == 0 and dug.into == "ic120"
    assert dug.parts["dig"] > 2.0, "also the time before the crash"


def test_a_crash_between_a_save_and_the_end_of_its_journal(pc: Pc, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tms_ground.journal.Journal.drop", lambda *_: None)
    pc.dig([*BUCKET, *[BACK] * 3])
    (first,) = pc.cycles("zx200")
    held = pc.load("ic120")
    pc.start()
    pc.look()
    assert pc.cycles("zx200") == [first] and pc.load("ic120") == pytest.approx(held), (
        "what the file holds is not told again"
    )


def test_a_journal_that_was_cut_off_counts_as_far_as_it_reaches(pc: Pc) -> None:
    pc.dig([*dig_poses(), Arm(-0.6, *HOLD)])
    held = pc.load("zx200")
    (journal,) = pc.ground.parent.glob("ground.journal.*")
    journal.write_bytes(journal.read_bytes()[:-30] + b"\x00" * 30)
    pc.start()
    pc.dig([Arm(-0.6, *HOLD), ABOVE])
    assert pc.load("zx200") == pytest.approx(held, rel=0.02)


def test_a_bucket_that_was_emptied_while_nobody_looked_is_in_the_truck(pc: Pc) -> None:
    """It swung over the truck, opened, and had swung half-way back when tms:ground was there again."""
    pc.dig([*dig_poses(), Arm(-0.3, *HOLD)])
    held = pc.load("zx200")
    pc.now += 8.0
    assert reasons(pc) == [GroundAway]
    half = OPEN._replace(swing=-0.8)
    pc.dig([half, BACK])
    assert pc.load("zx200") == 0.0 and pc.load("ic120") == pytest.approx(held, rel=0.01)
    (dug,) = pc.cycles("zx200")
    assert (dug.into, dug.number, dug.loose) == ("ic120", 1, pytest.approx(held, rel=0.01))
    assert again(pc, -1.2) == [1, 2]
    second = pc.cycles("zx200")[1]
    assert second.unseen == pytest.approx(8.0, abs=0.5), "its way back began while nobody looked"
    assert sum(second.parts.values()) + second.unseen == pytest.approx(second.seconds, abs=0.5)
    pc.tip()
    (hauled,) = pc.cycles("ic120")
    assert hauled.loose == pytest.approx(dug.loose + second.loose, rel=0.1) and hauled.buckets == 2


def test_a_bucket_that_came_out_of_the_ground_while_nobody_looked_holds_soil(pc: Pc) -> None:
    pc.dig(dig_poses()[:-2])
    up = dig_poses()[-1]
    assert pc.load("zx200") < 0.2
    pc.now += 6.0
    pc.start()
    pc.dig([up, up])
    assert 0.2 < pc.load("zx200") < 0.9
    pc.dig([up, ABOVE, *[OPEN] * 12, BACK])
    (dug,) = pc.cycles("zx200")
    assert dug.loose > 0.2 and dug.unseen == pytest.approx(6.0, abs=0.5), "marked as an estimate"


def full(*_: object) -> None:
    raise OSError(28, "No space left on device")
