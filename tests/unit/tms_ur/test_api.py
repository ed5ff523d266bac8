"""Every endpoint, every error, and what stands before them, with a site that is a fake."""

import asyncio
import csv
import inspect
import io
import math
import threading
import zipfile
from collections import Counter
from collections.abc import AsyncIterator
from datetime import datetime, timedelta
from pathlib import Path

import httpx
import pytest
from builtin_interfaces.msg import Time
from fastapi import FastAPI
from mcap.reader import make_reader
from rosbags.rosbag2 import Reader
from rosbags.typesys import Stores, get_typestore
from tms_msg_areas import msg as areas

from tms_config.clock import utc_now
from tms_decision.reasons import SoftwareStopBy
from tms_places.reasons import WaitingCircle
from tms_reason.errors import TmsError
from tms_reason.reason import Foreign
from tms_reason.wire import to_line
from tms_ur import messages
from tms_ur.api import WORKERS
from tms_ur.models import ActiveRun, Event, Host, Joint, Machine, Process
from tms_ur.reason_view import view
from tms_ur.recording_client import Asked
from tms_ur.security import SECURITY, is_loopback
from unit.tms_ur import fakes
from unit.tms_ur.fakes import HERE, NOON, XML, Client, FakeAudit, FakeSiteClient, WrongLine, app

READS = [
    "/api/tasks", "/api/tasks/4", "/api/runs", "/api/runs/r-1/events", "/api/runs/r-1/tree", "/api/runs/r-1/export",
    "/api/parameters", "/api/audit", "/api/processes/zx200:rc/log", "/api/templates", "/api/recordings",
]  # fmt: skip
RECORD = {"model_name": "zx200", "record_name": "pose", "fields": [{"name": "a", "type": "double", "value": 3}]}
COMMANDS = [
    ("/api/runs", {"task_id": 4}), ("/api/runs/r-1/cancel", {}), ("/api/runs/r-1/resume", {}),
    ("/api/runs/r-1/abandon", {}), ("/api/questions/q-1", {"yes": True}),
    ("/api/machines/zx200/rearm", {}), ("/api/tasks", {"xml": XML}), ("/api/tasks/4/remove", {}),
    ("/api/tasks/check", {"xml": XML}), ("/api/tasks/4/diff", {"xml": XML}), ("/api/parameters", RECORD),
    ("/api/processes/zx200:rc/restart", {}), ("/api/templates", {"name": "Dig", "xml": XML}),
    ("/api/machines/zx200/escape", {}), ("/api/places/road/revoke", {}), ("/api/machines/zx200/give-back", {}),
]  # fmt: skip


@pytest.fixture
def site_client() -> FakeSiteClient:
    return FakeSiteClient()


@pytest.fixture
def client(site_client: FakeSiteClient) -> Client:
    return Client(app(site_client))


def test_the_fake_has_the_methods_of_the_real_client() -> None:
    from tms_ur.site_client import SiteClient

    def methods(of: type) -> dict[str, inspect.Signature]:
        found = inspect.getmembers(of, inspect.isfunction)
        return {name: inspect.signature(method) for name, method in found if not name.startswith("_")}

    assert methods(FakeSiteClient) == methods(SiteClient)


# state


def test_state_before_anything_was_heard(client: Client) -> None:
    state = client.get("/api/state").json()
    assert state["machines"][0]["state"] == "silent"
    assert state["machines"][0]["age"] is None
    reason = state["machines"][0]["reason"]
    assert (reason["code"], reason["args"]) == ("MACHINE_UNHEARD", {"process": "zx200:rc"})
    assert reason["action"]["command"] == "tms ps"
    assert state["scheduler"] == {"alive": False, "age": None}
    assert state["runs"] == state["hosts"] == state["questions"] == []


def test_state_shows_what_was_heard(client: Client, site_client: FakeSiteClient) -> None:
    joint = Joint(name="swing_joint", position=1.5, velocity=0.1)
    site_client.board.put_machine(Machine(name="zx200", state="moving", joints=[joint], joint_age=0.0))
    site_client.board.put_runs([ActiveRun(run_id="r-2", task_id=4, state="running", machines=["zx200"])])
    site_client.board.put_host(Host(name="pc", processes=[Process(name="tms:ts", state="RUNNING", pid=7)]))
    state = client.get("/api/state").json()
    assert state["machines"][0]["state"] == "moving"
    assert state["machines"][0]["joints"] == [{"name": "swing_joint", "position": 1.5, "velocity": 0.1}]
    assert state["scheduler"]["alive"]
    assert state["runs"][0]["run_id"] == "r-2"
    assert state["hosts"][0]["processes"][0]["pid"] == 7


# stored things


def test_tasks(client: Client) -> None:
    assert client.get("/api/tasks").json()[0] == {
        "id": 4, "model_name": "zx200", "description": "掘削", "added_at": "2026-01-31T12:00:00Z",
    }  # fmt: skip
    assert client.get("/api/tasks/7").json()["xml"] == XML


def test_templates(client: Client, site_client: FakeSiteClient) -> None:
    assert client.get("/api/templates").json() == [
        {"name": "Dig", "model_name": "zx200", "description": "掘削", "added_at": "2026-01-31T12:00:00Z"}
    ]
    answer = client.post("/api/templates", json={"name": "Dig", "xml": XML, "replace": True})
    assert (answer.status_code, answer.json()) == (201, {"already_stored": False, "replaced": True})
    assert site_client.calls[-1] == ("add_template", "Dig", XML, "", True)
    assert client.post("/api/templates", json={"name": "", "xml": XML}).status_code == 422


def test_what_the_editor_draws_with(client: Client, site_client: FakeSiteClient) -> None:
    site_client.palette = "<root/>"
    palette = client.get("/api/palette").json()
    assert palette["xml"] == "<root/>"
    [machine] = palette["machines"]
    assert (machine["name"], machine["model"]) == ("zx200", "zx200")
    assert "subtask_zx200_change_pose" in machine["subtasks"]
    assert client.get("/api/templates/Dig").json() == {"xml": XML}
    assert site_client.calls == [("template", "Dig")]


def test_runs_and_events(client: Client, site_client: FakeSiteClient) -> None:
    assert client.get("/api/runs?limit=5").json()[0]["reason"]["text"]["en"] == "pose out of reach"
    assert client.get("/api/runs/r-1/events?after=6&limit=2").json()[0]["number"] == 7
    assert client.get("/api/runs/r-1/events").status_code == 200
    assert site_client.calls == [("runs", 5), ("events", "r-1", 6, 2), ("events", "r-1", 0, 1000)]


def test_parameters_keep_their_types(client: Client, site_client: FakeSiteClient) -> None:
    values = client.get("/api/parameters?model_name=zx200").json()[0]["values"]
    assert values == {"i": 3, "d": 3.0, "b": True, "s": "3", "dd": [1.0, 2.5], "nan": None}
    assert [type(values[name]) for name in ("i", "d", "b")] == [int, float, bool]
    assert site_client.calls == [("parameters", "zx200")]


# commands


def test_start_a_run(client: Client, site_client: FakeSiteClient) -> None:
    answer = client.post("/api/runs", json={"task_id": 4, "ignore_warnings": True})
    assert (answer.status_code, answer.json()) == (202, {"run_id": "r-2"})
    assert site_client.calls == [("start_run", 4, True)]


def test_stop_asks_every_machine_and_any_role_may(client: Client, site_client: FakeSiteClient) -> None:
    receipts = client.post("/api/stop", json={}).json()
    assert [(one["machine"], one["confirmed"], one["seconds"]) for one in receipts] == [("zx200", True, 0.4)]
    assert site_client.calls == [("stop", "zx200", SoftwareStopBy("local at 127.0.0.1"))]
    answer = client.post("/api/stop", json={"machine": "ic120"})
    assert (answer.status_code, answer.json()["code"]) == (404, "NO_MACHINE")
    assert answer.json()["args"] == {"machine": "ic120", "machines": ["zx200"]}


def test_rearm_has_two_steps(client: Client) -> None:
    first = client.post("/api/machines/zx200/rearm", json={}).json()
    assert (first["armed"], first["token"]) == (False, "t-1")
    assert client.post("/api/machines/zx200/rearm", json={"token": "t-1"}).json()["armed"]
    assert client.post("/api/machines/ic120/rearm", json={}).status_code == 404


def test_who_lets_a_machine_back_is_told_its_gateway(client: Client, site_client: FakeSiteClient) -> None:
    assert client.post("/api/machines/zx200/escape", json={}).is_success
    assert site_client.calls == [("let_back", "zx200", "local at 127.0.0.1")]
    assert client.post("/api/machines/ic120/escape", json={}).status_code == 404


def test_a_machine_is_given_back_by_name_with_the_receipt_of_its_stop(
    client: Client, site_client: FakeSiteClient
) -> None:
    answer = client.post("/api/machines/zx200/give-back", json={})
    assert (answer.status_code, answer.json()["confirmed"]) == (200, True)
    assert site_client.calls == [("give_back", "zx200", "local at 127.0.0.1")]
    assert client.post("/api/machines/ic120/give-back", json={}).status_code == 404


def test_answer_a_question(client: Client, site_client: FakeSiteClient) -> None:
    assert client.post("/api/questions/r-1-1", json={"yes": False}).status_code == 200
    assert site_client.calls == [("answer", "r-1-1", False, "local at 127.0.0.1")]
    site_client.error = TmsError(Foreign("answered meanwhile"), "NO_QUESTION")
    assert client.post("/api/questions/r-1-1", json={"yes": True}).status_code == 404


def test_tasks_are_checked_compared_and_stored(client: Client, site_client: FakeSiteClient) -> None:
    found = client.post("/api/tasks/check", json={"xml": XML}).json()
    assert found["errors"] == [{"line": 7, "reason": view(WrongLine(7, "Dig")).model_dump()}]
    assert found["warnings"] == [{"line": None, "reason": view(Foreign("nobody writes flag F")).model_dump()}]
    assert client.post("/api/tasks/4/diff", json={"xml": XML}).json() == {"text": ""}
    assert "+<root/>" in client.post("/api/tasks/4/diff", json={"xml": "<root/>"}).json()["text"]
    answer = client.post("/api/tasks", json={"xml": XML, "description": "掘削"})
    assert (answer.status_code, answer.json()) == (201, {"id": 5, "already_stored": False})
    large = client.post("/api/tasks", json={"xml": "x" * 100_000})
    assert large.status_code == 201  # trees may be larger than other commands


def test_values_of_records_have_types(client: Client, site_client: FakeSiteClient) -> None:
    assert client.post("/api/parameters", json=RECORD).status_code == 200
    (_, model, record, values, source, create, kind), *_ = site_client.calls
    assert (model, record, values, source, create, kind) == (
        "zx200", "pose", {"a": 3.0}, "local at 127.0.0.1", False, "",
    )  # fmt: skip
    assert isinstance(values["a"], float)


@pytest.mark.parametrize(
    ("kind", "value"), [("int", 3.5), ("bool", 1), ("int", True), ("double", "3"), ("int[]", 3), ("int", [3])]
)
def test_values_that_do_not_fit_their_type(
    client: Client, site_client: FakeSiteClient, kind: str, value: object
) -> None:
    body = {**RECORD, "fields": [{"name": "a", "type": kind, "value": value}]}
    answer = client.post("/api/parameters", json=body)
    assert (answer.status_code, answer.json()["code"]) == (409, "BAD_VALUE")
    assert site_client.calls == []


def test_an_angle_that_the_joint_cannot_have_is_refused(client: Client, site_client: FakeSiteClient) -> None:
    record = lambda angle: {**RECORD, "fields": [{"name": "boom_joint", "type": "double", "value": angle}]}  # noqa: E731
    answer = client.post("/api/parameters", json=record(0.5))
    assert (answer.status_code, answer.json()["code"]) == (409, "ANGLE_UNFIT")
    assert "boom_joint" in answer.json()["text"]["en"] and site_client.calls == []
    assert client.post("/api/parameters", json=record(-0.5)).status_code == 200


HUGE = str(10**400)


@pytest.mark.parametrize(
    ("kind", "value"),
    [
        ("string", '"\\ud800"'), ("string", '"a\\u0000b"'), ("string[]", '["a", "\\udfff"]'), ("int", str(2**63)),
        ("int[]", f"[1, {-(2**63) - 1}]"), ("double", HUGE), ("double", "1e400"), ("double", "NaN"),
        ("double[]", f"[1, -{HUGE}]"),
    ],
)  # fmt: skip
def test_values_that_neither_ros_nor_the_database_can_hold(site_client: FakeSiteClient, kind: str, value: str) -> None:
    audit = FakeAudit()
    fields = f'[{{"name": "a", "type": "{kind}", "value": {value}}}]'
    body = f'{{"model_name": "zx200", "record_name": "pose", "fields": {fields}}}'
    headers = {"Content-Type": "application/json"}
    answer = Client(app(site_client, audit=audit)).post("/api/parameters", content=body, headers=headers)
    assert (answer.status_code, answer.json()["code"]) == (409, "BAD_VALUE")
    assert site_client.calls == audit.notes == []


@pytest.mark.parametrize(
    ("kind", "value"), [("int", 2**63 - 1), ("int", -(2**63)), ("double", 2**70), ("string", "掘")]
)
def test_values_at_the_limits(client: Client, site_client: FakeSiteClient, kind: str, value: object) -> None:
    body = {**RECORD, "fields": [{"name": "a", "type": kind, "value": value}]}
    assert client.post("/api/parameters", json=body).status_code == 200
    assert site_client.calls[0][3] == {"a": value}


@pytest.mark.parametrize("key", ["model_name", "record_name", "name", "\\ud800"])
def test_names_are_unicode(client: Client, site_client: FakeSiteClient, key: str) -> None:
    names = {"model_name": "zx200", "record_name": "pose", "name": "a", key: "\\ud800"}
    name = names.pop("name")
    reported = ", ".join(f'"{one}": "{text}"' for one, text in names.items())
    body = f'{{{reported}, "fields": [{{"name": "{name}", "type": "int", "value": 1}}]}}'
    answer = client.post("/api/parameters", content=body, headers={"Content-Type": "application/json"})
    assert (answer.status_code, answer.json()["code"]) == (422, "BAD_REQUEST")
    assert site_client.calls == []


@pytest.mark.parametrize(
    ("path", "body"),
    [
        ("/api/parameters", {**RECORD, "record_name": "ev\0il"}),
        ("/api/parameters", {**RECORD, "model_name": "zx\x01"}),
        ("/api/parameters", {**RECORD, "fields": [{"name": "a\0b", "type": "int", "value": 1}]}),
        ("/api/tasks", {"xml": XML, "description": "dig\0here"}),
        ("/api/tasks", {"xml": XML, "description": "two\nlines"}),
        ("/api/login", {"name": "min\0a", "password": "long enough"}),
        ("/api/machines/zx200%00/rearm", {}), ("/api/questions/q%0A1", {"yes": True}), ("/api/runs/r%001/cancel", {}),
        ("/api/processes/tms:ts%00/restart", {}), ("/api/stop", {"machine": "zx200\0"}),
    ],
)  # fmt: skip
def test_no_name_holds_a_control_character(
    client: Client, site_client: FakeSiteClient, path: str, body: dict[str, object]
) -> None:
    answer = client.post(path, json=body)
    assert (answer.status_code, answer.json()["code"]) == (422, "BAD_REQUEST")
    assert site_client.calls == []


def test_processes(client: Client, site_client: FakeSiteClient) -> None:
    assert client.get("/api/processes/zx200:rc/log?size=1000").json() == {"text": "event=started\n"}
    assert client.post("/api/processes/zx200:rc/restart", json={}).status_code == 200
    assert site_client.calls == [("log", "zx200:rc", 1000), ("restart", "zx200:rc")]
    assert client.get("/api/processes/a%2Fb/log").status_code in (404, 422)


def test_shared_places(client: Client, site_client: FakeSiteClient) -> None:
    assert client.get("/api/places").json() == {"places": [], "alarms": []}
    queue = [areas.PlaceRequest(machine="ic120", run="r-2", since=Time(sec=100))]
    place = areas.Place(name="road", state=areas.Place.HELD, holder="zx200", run="r-1", since=Time(sec=60), queue=queue)
    circle = to_line(WaitingCircle(("zx200", "ic120", "zx200")))
    site_client.board.put_shared(messages.shared_places(areas.Places(places=[place], alarms=[circle])))
    told = client.get("/api/places").json()
    (road,) = told["places"]
    assert (road["state"], road["holder"], road["since"]) == ("held", "zx200", "1970-01-01T00:01:00Z")
    assert [one["machine"] for one in road["queue"]] == ["ic120"] and told["alarms"][0]["code"] == "WAITING_CIRCLE"
    assert client.get("/api/state").json()["shared"] == told
    assert client.post("/api/places/road/revoke", json={}).json() == {"place": "road", "holder": "zx200"}
    assert site_client.calls == [("revoke", "road", "local at 127.0.0.1")]


def test_tree_of_a_run(client: Client, site_client: FakeSiteClient) -> None:
    tree = client.get("/api/runs/r-1/tree").json()
    assert (tree["names"], tree["templates"]) == (["all"], []), "journals of earlier releases know no templates"
    (_, shape) = site_client.events("r-1", 0, 2)
    shape.values["templates"] = ["Dig:5"]
    site_client.events = lambda *_: [shape]  # type: ignore[method-assign]
    assert client.get("/api/runs/r-1/tree").json()["templates"] == ["Dig:5"]


@pytest.mark.parametrize(
    ("form", "begins"), [("json", b"{"), ("csv", b"\xef\xbb\xbfrun_id"), ("mcap", b"\x89MCAP0\r\n")]
)
def test_exports(client: Client, form: str, begins: bytes) -> None:
    answer = client.get(f"/api/runs/r-1/export?form={form}")
    assert answer.content.startswith(begins)
    assert answer.headers["content-disposition"] == f'attachment; filename="r-1.{form}"'


def test_a_recording_by_run_or_time(client: Client, site_client: FakeSiteClient) -> None:
    series = client.get("/api/recordings?run_id=r-1&points=500").json()["series"]
    assert [(one["machine"], one["kind"], len(one["times"])) for one in series] == [
        ("zx200", "joints", 101), ("zx200", "load", 11), ("zx200", "pose", 51),
    ]  # fmt: skip
    assert [len(values) for values in series[0]["values"]] == [101, 101]
    client.get("/api/recordings?end=5e8&machine=zx200")
    later = NOON.timestamp() + 3600
    assert client.get(f"/api/recordings?begin={later}").json() == {"series": []}
    assert site_client.calls == [
        ("recording", Asked("r-1", 0, 0, "", 500)), ("recording", Asked("", 0, 5e8, "zx200", 2000)),
        ("recording", Asked("", later, 0, "", 2000)),
    ]  # fmt: skip
    assert client.get("/api/recordings?points=1").status_code == 422


def test_a_recording_as_a_table(client: Client, site_client: FakeSiteClient) -> None:
    answer = client.get("/api/recordings/r-1/export?form=csv")
    assert answer.headers["content-disposition"] == 'attachment; filename="r-1-motion.csv"'
    rows = list(csv.reader(io.StringIO(answer.content.decode("utf-8-sig"))))
    assert rows[0] == [
        "time", "zx200/boom_joint [rad]", "zx200/swing_joint [rad]", "zx200/bank [m3]", "zx200/loose [m3]",
        "zx200/mass [kg]", "zx200/x [m]", "zx200/y [m]", "zx200/yaw [rad]",
    ]  # fmt: skip
    assert len(rows) == 102
    assert rows[1] == ["2026-01-31T12:00:00.000+00:00", "-0.5", "0.0", "0.0", "0.0", "0.0", "0.0", "2.0", "0.5"]
    assert rows[2] == ["2026-01-31T12:00:00.100+00:00", "-0.5", "0.01", "", "", "", "", "", ""]
    site_client.unrecorded = True
    assert client.get("/api/recordings/r-1/export?form=csv").content.decode("utf-8-sig") == "time\r\n"


def test_a_recording_for_foxglove_and_rosbag2(client: Client, site_client: FakeSiteClient, tmp_path: Path) -> None:
    file = tmp_path / "r-1.mcap"
    file.write_bytes(client.get("/api/recordings/r-1/export").content)
    with file.open("rb") as opened:
        found = Counter(channel.topic for _, channel, _ in make_reader(opened).iter_messages())
    assert found == {"/tms/events": 2, "/zx200/joint_states": 101, "/zx200/pose": 51, "/tf": 152,
                     **{f"/zx200/load/{name}": 11 for name in ("mass", "bank", "loose")}}  # fmt: skip
    with Reader(file) as bag:
        types = get_typestore(Stores.ROS2_JAZZY)
        told = [(one.topic, types.deserialize_cdr(data, one.msgtype)) for one, _, data in bag.messages()]
    events = [(message.line, message.name, message.msg) for topic, message in told if topic == "/tms/events"]
    assert events == [(1, "run", "running"), (2, "tree", "1 node")]
    assert [message.data for topic, message in told if topic == "/zx200/load/mass"] == [0.0, *[1600.0] * 10]
    arm = [message for topic, message in told if topic == "/zx200/joint_states"][50]
    assert (arm.name, arm.position.tolist()) == (["swing_joint", "boom_joint"], [0.5, -0.5])
    (links, *_) = [message.transforms for topic, message in told if topic == "/tf" and len(message.transforms) > 1][50:]
    swing = links[1].transform.rotation
    assert (links[1].header.frame_id, links[1].child_frame_id) == ("zx200/track_link", "zx200/body_link")
    assert (swing.x, swing.y, abs(swing.z)) == pytest.approx((0.0, 0.0, math.sin(0.25)), abs=1e-9)
    base = [message.transforms[0] for topic, message in told if topic == "/tf" and len(message.transforms) == 1][-1]
    assert (base.header.frame_id, base.child_frame_id) == ("map", "zx200/base_link")
    assert (base.transform.translation.x, base.transform.translation.y) == (10.0, 2.0)


def test_a_recording_that_cannot_be_read_is_no_file(client: Client, site_client: FakeSiteClient) -> None:
    site_client.error = TmsError(Foreign("away"), "STORE_DOWN")
    assert client.get("/api/recordings/r-1/export").status_code == 503


@pytest.mark.parametrize(
    ("stored", "last"), [(2000, "event 2000"), (2001, 'JOURNAL_CUT count=2000 run="r-1" last=2000')]
)
def test_an_export_that_is_cut_says_so(
    client: Client, site_client: FakeSiteClient, monkeypatch: pytest.MonkeyPatch, stored: int, last: str
) -> None:
    def events(run_id: str, after: int, limit: int) -> list[Event]:
        numbers = range(after + 1, stored + 1)[:limit]
        return [Event(number=number, kind="node", node="", text=f"event {number}") for number in numbers]

    monkeypatch.setattr(site_client, "events", events)
    monkeypatch.setattr("tms_ur.reading.MAX_EVENTS", 2000)
    assert client.get("/api/runs/r-1/export").json()["events"][-1]["text"].startswith(last)


def test_every_command_is_audited(site_client: FakeSiteClient) -> None:
    audit = FakeAudit()
    client = Client(app(site_client, audit=audit))
    for path, body in [*COMMANDS, ("/api/stop", {})]:
        assert client.post(path, json=body).is_success, path
    assert {what for _, _, what, _ in audit.notes} == {
        "start_run", "cancel_run", "answer", "rearm_asked", "escape_asked", "add_task", "remove_task", "set_parameter",
        "restart", "stop", "add_template", "revoke_place_asked", "resume_run", "abandon_run", "give_back",
    }  # fmt: skip
    assert {(who, where) for who, where, _, _ in audit.notes} == {("local", "127.0.0.1")}


def journal(monkeypatch: pytest.MonkeyPatch, site_client: FakeSiteClient, rows: dict[int, datetime]) -> Client:
    """The audit's entries by number, with their time."""
    audit = FakeAudit()
    audit.last = max(rows, default=0)

    def events(run_id: str, after: int, limit: int) -> list[Event]:
        assert run_id == "audit"
        numbers = [number for number in sorted(rows) if number > after][:limit]
        if not numbers:
            raise TmsError(Foreign("there is no run 'audit'"), "RUN_MISSING")
        return [Event(number=number, stamp=rows[number], kind="stop", node="", text="") for number in numbers]

    monkeypatch.setattr(site_client, "events", events)
    return Client(app(site_client, audit=audit))


def shown(client: Client, query: str = "") -> list[int]:
    return [row["number"] for row in client.get(f"/api/audit{query}").json()]


def test_the_audit_shows_the_newest(site_client: FakeSiteClient, monkeypatch: pytest.MonkeyPatch) -> None:
    """An entry every half minute."""
    now = utc_now()
    client = journal(monkeypatch, site_client, {n: now - timedelta(seconds=30 * (2500 - n)) for n in range(1, 2500)})
    assert shown(client) == list(range(1500, 2500))
    assert shown(client, "?limit=2") == [2498, 2499]
    assert shown(client, "?hours=0.05") == list(range(2495, 2500))
    assert shown(journal(monkeypatch, site_client, {})) == []


def test_the_audit_shows_entries_from_before_that_were_numbered_by_the_clock(
    site_client: FakeSiteClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    now = utc_now()
    old = {1_790_000_000 - 3000 * n: now - timedelta(seconds=3000 * n) for n in range(1, 40)}
    client = journal(monkeypatch, site_client, {**old, 1_790_000_001: now})
    assert len(shown(client)) == 29  # of the last 24 h
    assert shown(client, "?limit=3") == [1_790_000_000 - 6000, 1_790_000_000 - 3000, 1_790_000_001]


def test_a_stop_waits_for_no_audit_and_other_commands_for_a_moment(
    site_client: FakeSiteClient, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    audit = FakeAudit()
    audit.kept.clear()  # its disk hangs
    client = Client(app(site_client, audit=audit))
    monkeypatch.setattr("tms_ur.commands.KEPT_LIMIT", 300.0)  # whoever waits for it fails by the test's own limit
    assert client.post("/api/stop", json={}).status_code == 200
    assert client.post("/api/runs/r-1/cancel", json={}).status_code == 202
    monkeypatch.setattr("tms_ur.commands.KEPT_LIMIT", 0.01)
    assert "event=audit_late" not in caplog.text
    assert client.post("/api/runs", json={"task_id": 4}).status_code == 202
    assert "event=audit_late what=start_run" in caplog.text


def test_refused_strangers_are_audited(site_client: FakeSiteClient) -> None:
    audit = FakeAudit()
    client = Client(app(site_client, audit=audit))
    client.post("/api/stop", json={}, headers={"Origin": "http://evil.example"})
    client.get("/api/state", headers={"Host": "evil.example"})
    where = ("-", "127.0.0.1", "refused")
    assert audit.refusals == [(*where, "FOREIGN_ORIGIN"), (*where, "FOREIGN_HOST")]
    assert audit.notes == []


def test_the_site_is_described(client: Client) -> None:
    site = client.get("/api/site").json()
    (machine,) = site["machines"]
    assert (machine["name"], machine["kind"]) == ("zx200", "backhoe")
    assert [one["child"] for one in machine["joints"]][-1] == "bucket_end_link"
    assert {one["link"] for one in machine["solids"]} <= {one["child"] for one in machine["joints"]}
    assert machine["solids"][0]["role"] == "track" and machine["solids"][0]["y"] == [[-1.44, -0.75], [0.75, 1.44]]


def test_a_machine_as_a_ros_package(client: Client) -> None:
    answer = client.get("/api/machines/zx200/urdf")
    assert answer.headers["content-disposition"] == 'attachment; filename="zx200_description.zip"'
    with zipfile.ZipFile(io.BytesIO(answer.content)) as found:
        assert "zx200_description/urdf/zx200.urdf" in found.namelist()
    assert client.get("/api/machines/zx999/urdf").json()["code"] == "NO_MACHINE"


def test_areas_are_enabled_as_they_were_shown(client: Client, site_client: FakeSiteClient) -> None:
    drawn = {"type": "FeatureCollection", "frame": "map", "features": []}
    assert client.post("/api/areas/check", json={"areas": drawn}).json()["changes"][0]["away"] == 25.0
    assert client.post("/api/areas/enable", json={"areas": drawn, "id": "a0"}).status_code == 200
    (enabled,) = (call for call in site_client.calls if call[0] == "enable_areas")
    assert enabled[1:3] == (drawn, "a0")


def test_the_ground_of_a_site_that_keeps_one(site_client: FakeSiteClient) -> None:
    assert Client(app(site_client, ground=None)).get("/api/ground").json()["rows"] == 0
    found = Client(app(site_client)).get("/api/ground?cells=500").json()
    assert (found["heights"], found["design"]) == ([1.25, None], [0.5, None])
    assert site_client.calls == [("ground", 500)]


def test_the_ground_of_a_moment(client: Client, site_client: FakeSiteClient) -> None:
    found = client.get("/api/ground?at=2026-01-31T21:00:01%2B09:00").json()
    assert found["heights"] == [0.75, None] and found["taken_at"] < found["next_at"]
    assert site_client.calls == [("ground_at", NOON + timedelta(seconds=1), 40_000)]
    gone = client.get("/api/ground?at=1999-01-01T00:00:00Z")
    assert (gone.status_code, gone.json()["code"]) == (404, "GROUND_NOT_THERE")
    assert client.get("/api/ground?at=2026-01-31T21:00:01").status_code == 422, "a time without a zone"


def test_the_work_of_a_day_beside_its_plan(site_client: FakeSiteClient) -> None:
    ground = {"area": [-10.0, -10.0, 10.0, 10.0], "plan": {"bank": 300.0, "loads": 50}}
    found = Client(app(site_client, ground=ground)).get("/api/work?day=2026-11-26").json()
    assert (found["day"], found["plan"]) == ("2026-11-26", {"bank": 300.0, "loads": 50})
    assert found["total"]["bank"] == pytest.approx(8.0) and found["total"]["loads"] == 1
    assert [one["name"] for one in found["machines"]] == ["ic120", "zx200"]
    assert [one["cycles"] for one in found["hours"]] == [5, 5]
    today = Client(app(site_client)).get("/api/work").json()
    assert today["day"] == utc_now().astimezone().date().isoformat() and today["plan"] is None
    assert Client(app(site_client)).get("/api/work?day=0001-01-01").status_code == 422, "no zone tells its begin"


def test_the_daily_report_as_a_file(site_client: FakeSiteClient) -> None:
    client = Client(app(site_client, ground={"area": [-10.0, -10.0, 10.0, 10.0], "plan": {"bank": 16.0}}))
    page = client.get("/api/work/report?day=2026-11-26&form=html&language=ja")
    assert page.headers["content-disposition"] == 'attachment; filename="daily-report-2026-11-26.html"'
    assert page.headers["content-type"] == "text/html; charset=utf-8"
    assert "作業日報 demo 2026-11-26" in page.text and "<td>16.0</td><td>8.0</td><td>50 %</td>" in page.text
    sheet = client.get("/api/work/report")
    assert sheet.headers["content-type"] == "application/pdf" and sheet.content.startswith(b"%PDF")
    assert site_client.calls[-1][1].day == utc_now().astimezone().date() and site_client.calls[-1][1].language == "en"
    assert client.get("/api/work/report?form=doc").status_code == 422
    assert client.get("/api/work/report?day=0001-01-01").status_code == 422


def test_resume_or_abandon_an_interrupted_run(client: Client, site_client: FakeSiteClient) -> None:
    assert client.get("/api/runs/r-1/resume").json() == {"task_id": 4, "done": ["dig"], "next": ["swing"]}
    assert client.post("/api/runs/r-1/resume", json={}).json() == {"run_id": "r-1"}
    assert client.post("/api/runs/r-1/abandon", json={}).json() == {"run_id": "r-1"}
    assert site_client.calls == [("resume_plan", "r-1"), ("start_run", 0, True, "r-1"), ("abandon_run", "r-1")]


def test_what_a_node_sees_of_the_blackboard(client: Client, site_client: FakeSiteClient) -> None:
    found = client.get("/api/runs/r-1/blackboard?node=0.1")
    assert found.json() == {"values": {"target": "R7", "count": 3}}
    assert site_client.calls == [("blackboard", "r-1", "0.1")]
    assert client.get("/api/runs/r-1/blackboard?node=x").status_code == 422


def test_which_machines_a_task_moves(site_client: FakeSiteClient, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fakes, "XML", "<root><A model_name='zx200'/></root>")
    assert Client(app(site_client)).get("/api/tasks/4/machines").json() == {"machines": ["zx200"]}


def test_cancel_a_run(client: Client, site_client: FakeSiteClient) -> None:
    answer = client.post("/api/runs/r-1/cancel", json={})
    assert (answer.status_code, answer.json()) == (202, {"run_id": "r-1"})
    assert site_client.calls == [("cancel_run", "r-1")]


@pytest.mark.parametrize(
    ("code", "status"),
    [
        ("TASK_MISSING", 404), ("RUN_MISSING", 404), ("NO_RUN", 404), ("MACHINE_BUSY", 409), ("PREFLIGHT", 409),
        ("START_REFUSED", 409), ("NO_SERVER", 503), ("NO_ANSWER", 503), ("RUN_NOT_BEGUN", 503), ("STORE_DOWN", 503),
    ],
)  # fmt: skip
def test_errors_of_modules(client: Client, site_client: FakeSiteClient, code: str, status: int) -> None:
    site_client.error = TmsError(Foreign("what is wrong and what to do"), code)
    reads = [path for path in READS if code != "RUN_MISSING" or path != "/api/audit"]  # nothing was audited then
    answers = [client.get(path) for path in reads] + [client.post(path, json=body) for path, body in COMMANDS]
    for answer in answers:
        assert answer.status_code == status
        assert answer.json() == {**view(Foreign("what is wrong and what to do")).model_dump(), "code": code}


@pytest.mark.parametrize(
    "path",
    [
        "/api/tasks/0", "/api/tasks/x", "/api/tasks/2147483648", "/api/runs?limit=0", "/api/runs?limit=1001",
        "/api/runs/a%20b/events", "/api/runs/r/events?after=-1", "/api/runs/r/events?after=4294967296",
        "/api/parameters?model_name=a/b", "/api/parameters/history?record_name=ev%00il",
    ],
)  # fmt: skip
def test_bad_values(client: Client, site_client: FakeSiteClient, path: str) -> None:
    answer = client.get(path)
    assert answer.status_code == 422
    assert answer.json()["code"] == "BAD_REQUEST"
    assert site_client.calls == []


@pytest.mark.parametrize(
    "body", [b"{", b"[]", b"{}", b'{"task_id": "4"}', b'{"task_id": 0}', b'{"task_id": 4, "speed": 9}', b"\xff"]
)
def test_bad_commands(client: Client, site_client: FakeSiteClient, body: bytes) -> None:
    answer = client.post("/api/runs", content=body, headers={"Content-Type": "application/json"})
    assert answer.status_code in (400, 422)
    assert answer.json()["code"] == "BAD_REQUEST"
    assert site_client.calls == []


def test_unknown_path_and_method(client: Client) -> None:
    assert client.get("/api/nothing").json()["code"] == "NOT_FOUND"
    answer = client.request("PUT", "/api/tasks", json={})
    assert (answer.status_code, answer.json()["code"]) == (405, "METHOD_NOT_ALLOWED")


def test_a_bug_is_told_without_its_insides(site_client: FakeSiteClient) -> None:
    site_client.error = ZeroDivisionError("inside")  # type: ignore[assignment]
    client = Client(app(site_client))
    answer = client.get("/api/tasks")
    assert (answer.status_code, answer.json()["code"]) == (500, "INTERNAL_ERROR")
    assert "inside" not in answer.text
    assert answer.headers["X-Content-Type-Options"] == "nosniff"


# what stands before


@pytest.mark.parametrize("path", ["/", "/dom.js", "/api/state", "/api/nothing", "/api/tasks/x", "/openapi.json"])
def test_security_headers_are_everywhere(client: Client, path: str) -> None:
    headers = client.get(path).headers
    assert {name: headers[name] for name in SECURITY} == SECURITY
    assert headers["Cache-Control"] == ("no-store" if path.startswith("/api/") else "no-cache")


@pytest.mark.parametrize("host", ["evil.example", "evil.example:8080", "127.0.0.1.evil.example", "", "[", "192.0.2.1"])
def test_foreign_names_are_not_answered(client: Client, site_client: FakeSiteClient, host: str) -> None:
    for answer in (
        client.get("/api/tasks", headers={"Host": host}),
        client.post("/api/runs", json={"task_id": 4}, headers={"Host": host}),
    ):
        assert (answer.status_code, answer.json()["code"]) == (400, "FOREIGN_HOST")
        assert answer.headers["X-Frame-Options"] == "DENY"
    assert site_client.calls == []


@pytest.mark.parametrize("host", ["localhost", "LOCALHOST:8080", "127.0.0.1:1", "[::1]:8080"])
def test_own_names_are_answered(client: Client, host: str) -> None:
    assert client.get("/api/state", headers={"Host": host}).status_code == 200


def test_bound_to_all_addresses_numbers_are_answered(site_client: FakeSiteClient) -> None:
    client = Client(app(site_client, "0.0.0.0"), base_url="http://192.0.2.1:8080")
    assert client.get("/api/state").status_code == 200
    assert client.get("/api/state", headers={"Host": "evil.example"}).status_code == 400


@pytest.mark.parametrize(
    "origin", ["http://evil.example", "null", "http://127.0.0.1:9999", "http://localhost:8080", "file://", ""]
)
def test_commands_from_foreign_pages_are_refused(client: Client, site_client: FakeSiteClient, origin: str) -> None:
    for path, body in COMMANDS:
        answer = client.post(path, json=body, headers={"Origin": origin})
        assert (answer.status_code, answer.json()["code"]) == (403, "FOREIGN_ORIGIN")
    assert site_client.calls == []


def test_commands_from_our_own_page(client: Client) -> None:
    assert client.post("/api/runs", json={"task_id": 4}, headers={"Origin": HERE}).status_code == 202


@pytest.mark.parametrize("kind", ["text/plain", "application/x-www-form-urlencoded", "multipart/form-data", ""])
def test_commands_are_json(client: Client, site_client: FakeSiteClient, kind: str) -> None:
    answer = client.post("/api/runs", content=b'{"task_id": 4}', headers={"Content-Type": kind})
    assert (answer.status_code, answer.json()["code"]) == (415, "NOT_JSON")
    assert site_client.calls == []


def test_commands_are_short(client: Client, site_client: FakeSiteClient) -> None:
    async def chunks() -> AsyncIterator[bytes]:
        yield b"{}"

    kind = {"Content-Type": "application/json"}
    long = client.post("/api/runs", content=b" " * 20_000, headers=kind)
    unknown = client.post("/api/runs", content=chunks(), headers=kind)
    assert (long.status_code, long.json()["code"]) == (413, "REQUEST_TOO_LARGE")
    assert (unknown.status_code, unknown.json()["code"]) == (411, "NO_LENGTH")
    framed = {"Content-Length": "2", "Transfer-Encoding": "chunked"}
    both = client.post("/api/runs", content=chunks(), headers={**kind, **framed})  # the chunks count
    assert (both.status_code, both.json()["code"]) == (411, "NO_LENGTH")
    assert site_client.calls == []


@pytest.mark.parametrize("bind", ["0.0.0.0", "192.0.2.7", "::", "site-pc"])
def test_commands_need_loopback(site_client: FakeSiteClient, bind: str) -> None:
    client = Client(app(site_client, bind), base_url="http://localhost:8080")
    assert client.get("/api/tasks").status_code == 200
    site_client.calls.clear()
    for path, body in COMMANDS:
        answer = client.post(path, json=body)
        assert (answer.status_code, answer.json()["code"]) == (403, "NO_ACCESS_CONTROL")
        assert answer.json()["args"] == {"bind": bind}
    assert site_client.calls == []


def test_loopback() -> None:
    assert all(map(is_loopback, ["127.0.0.1", "127.1.2.3", "::1", "localhost"]))
    assert not any(map(is_loopback, ["0.0.0.0", "::", "192.0.2.7", "site-pc", ""]))


# scenes


def test_the_scene_of_an_excavator(client: Client, site_client: FakeSiteClient) -> None:
    found = client.get("/api/machines/zx200/scene").json()
    (body,) = found["bodies"]
    assert (body["kind"], body["size"], body["margin"], body["age"]) == ("machine", [2.0, 2.0, 4.0], 0.5, 3.0)
    assert body["position"] == [8.0, 2.0, 2.0] and body["triangles"] == 1
    assert body["name"]["text"]["en"] == "vessel of ic120_1"
    assert found["areas"] == [{"record": "dig", "centre": [5.0, 0.0, 0.0], "size": [2.0, 1.0, 0.5]}]
    assert found["way"] == [[6.0, 0.0, 1.0]]
    assert site_client.calls == [("scene", "zx200")]


def test_a_scene_that_there_is_not(site_client: FakeSiteClient) -> None:
    machines = {"zx200": {"model": "zx200"}, "ic120": {"model": "ic120"}}
    client = Client(app(site_client, machines=machines))
    assert client.get("/api/machines/nobody/scene").status_code == 404
    answer = client.get("/api/machines/ic120/scene")
    assert (answer.status_code, answer.json()["code"]) == (409, "NO_PLANNED_ARM")
    assert site_client.calls == []


# the document


def test_the_document_is_made_once_when_it_is_asked_for(
    site_client: FakeSiteClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It takes as long as all the rest of the application, which starts a hundred times for each time it is read."""
    made, make = list[FastAPI](), FastAPI.openapi
    monkeypatch.setattr(FastAPI, "openapi", lambda app: (made.append(app), make(app))[1])
    client = Client(app(site_client))
    assert made == []
    first, second = (client.get("/openapi.json") for _ in range(2))
    assert first.content == second.content and len(made) == 1


def test_it_is_made_once_for_all_who_wait_and_nobody_else_waits(
    client: Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    """To make it in all the threads at once kept a press of the stop for 1.4 s."""
    may_end, made = threading.Event(), list[bool]()
    monkeypatch.setattr(FastAPI, "openapi", lambda _: made.append(may_end.wait(60)) or {"made": len(made)})

    async def ask() -> list[httpx.Response]:
        transport = httpx.ASGITransport(client.app, client=("127.0.0.1", 123))
        async with httpx.AsyncClient(transport=transport, base_url=HERE) as asked:
            documents = [asyncio.create_task(asked.get("/openapi.json")) for _ in range(3 * WORKERS)]
            tasks = await asyncio.wait_for(asked.get("/api/tasks"), 30)
            may_end.set()
            return [tasks, *await asyncio.gather(*documents)]

    tasks, *documents = asyncio.run(ask())
    assert tasks.status_code == 200
    assert [one.json() for one in documents] == [{"made": 1}] * 3 * WORKERS


def test_every_endpoint_is_in_the_document(client: Client) -> None:
    document = client.get("/openapi.json").json()
    assert set(document["paths"]) == {
        "/api/state", "/api/events", "/api/tasks", "/api/tasks/{task_id}", "/api/runs", "/api/runs/{run_id}/events",
        "/api/runs/{run_id}/cancel", "/api/runs/{run_id}/resume", "/api/runs/{run_id}/abandon", "/api/parameters",
        "/api/tasks/{task_id}/machines", "/api/runs/{run_id}/blackboard",
        "/api/parameters/history", "/api/sensing", "/api/site", "/api/session", "/api/login", "/api/logout",
        "/api/stop", "/api/machines/{name}/rearm", "/api/machines/{name}/escape",
        "/api/machines/{name}/give-back",
        "/api/questions/{question_id}", "/api/tasks/check",
        "/api/tasks/{task_id}/diff", "/api/tasks/{task_id}/remove", "/api/runs/{run_id}/tree",
        "/api/runs/{run_id}/export", "/api/audit", "/api/machines/{name}/scene",
        "/api/processes/{name}/log", "/api/processes/{name}/restart",
        "/api/templates", "/api/areas", "/api/areas/check", "/api/areas/enable", "/api/ground", "/api/work",
        "/api/work/report", "/api/machines/{name}/urdf",
        "/api/places", "/api/palette", "/api/templates/{name}", "/api/places/{name}/revoke",
        "/api/recordings", "/api/recordings/{run_id}/export", "/api/logs",
    }  # fmt: skip
    assert {method for path in document["paths"].values() for method in path} == {
        "get",
        "post",
    }  # as in security.py
    problem = document["paths"]["/api/runs"]["post"]["responses"]["409"]["content"]["application/json"]["schema"]
    assert problem == {"$ref": "#/components/schemas/ReasonView"}
    assert document["components"]["schemas"]["Joint"]["properties"]["position"]["description"] == "rad"


# areas


def test_the_enabled_areas(client: Client) -> None:
    found = client.get("/api/areas").json()
    assert found["id"] == "9f" and found["by"] == "a person"
    assert found["areas"]["features"][0]["properties"] == {"id": "yard", "type": "unmanned"}
