"""Metrics, health, alerts, logs and diagnostics of a running mesh, with a real Prometheus where there is one."""

import json
import re
import threading
import urllib.error
from datetime import datetime
from pathlib import Path
from typing import Any

import pytest
from diagnostic_msgs.msg import DiagnosticArray

from conftest import CLI, PROJECT, Mesh, ports_of, wait_until
from prometheus_server import get, processes_up, prometheus, query
from tms_config.clock import utc_now
from tms_config.config import load_site
from tms_db import store, store_address
from tms_ros.node import Ros

pytestmark = pytest.mark.system
NEEDS_A_RUN = ("tms_ts_runs", "tms_action_goals", "tms_ts_handover_seconds")
CHOSEN_BY_SITE = ("tms_sp_", "tms_if_", "tms_ground_")  # processes that this mesh does not have


def targets(mesh: Mesh) -> dict[str, str]:
    """process -> host:port of what starts by itself."""
    rows = json.loads(mesh.tms("prometheus", "--json").stdout)["targets"]
    return {row["labels"]["process"]: row["targets"][0] for row in rows if row["labels"]["on_demand"] == "no"}


def test_prometheus_sees_every_process_and_a_lost_one_fires(mesh: Mesh, domain: int, tmp_path: Path) -> None:
    wanted = set(targets(mesh))
    mesh.tms("prometheus", "-o", str(tmp_path))
    with prometheus(tmp_path, ports_of(domain) + 95) as address:
        wait_until(lambda: processes_up(address) >= wanted, 30, f"scraped: all of {sorted(wanted)}")
        assert {row["metric"]["machine"] for row in query(address, "tms_rc_permit")} == {"zx200"}
        assert query(address, 'min_over_time(up{on_demand="no"}[5s]) == 0') == []
        mesh.tms("stop-process", "tms:ur")
        try:
            alert = 'ALERTS{alertname="TmsProcessDown", process="tms:ur"}'
            wait_until(lambda: bool(query(address, alert)), 30, "an alert for the process that was stopped")
            assert not query(address, 'ALERTS{alertname="TmsProcessDown", process!="tms:ur"}')
        finally:
            mesh.tms("start", "tms:ur")
            mesh.wait_ready()


def test_every_metric_that_rules_and_dashboards_ask_for_is_there(mesh: Mesh) -> None:
    mesh.tms("run", "1", "--wait", "--json")
    pages = "".join(get(f"http://{address}/metrics") for address in targets(mesh).values())
    there = set(re.findall(r"^(tms_\w+?)(?:\{| )", pages, re.M))
    files = [PROJECT / "deploy/prometheus/rules.yml", *(PROJECT / "deploy/grafana/dashboards").glob("*.json")]
    asked = {name for file in files for name in re.findall(r"\btms_[a-z_0-9]+", file.read_text(encoding="utf-8"))}
    missing = {name for name in asked - there if not name.startswith(CHOSEN_BY_SITE)}
    assert missing == set()
    for name in NEEDS_A_RUN:
        assert re.search(rf"^{name}\w*(\{{.*\}})? [1-9]", pages, re.M), name


def test_metrics_are_named_as_prometheus_wants_and_labels_are_bounded(mesh: Mesh) -> None:
    pages = {name: get(f"http://{address}/metrics") for name, address in targets(mesh).items()}
    for name, page in pages.items():
        kinds = dict(re.findall(r"^# TYPE (tms_\w+) (\w+)", page, re.M))
        assert kinds, name
        wrong = [m for m, kind in kinds.items() if (kind == "counter") != m.endswith("_total")]
        assert wrong == [], name
        labels = set(re.findall(r"[{,](\w+)=", "".join(re.findall(r"^tms_\w+(\{.*\}) ", page, re.M))))
        assert not labels & {"goal", "run", "run_id", "record", "task"}, f"{name}: unbounded labels"
        assert page.count("\n") < 1500, f"{name}: too many series"


def test_health_and_readiness_are_two_things(mesh: Mesh) -> None:
    address = targets(mesh)["tms:ts"]
    assert get(f"http://{address}/healthz") == "ok\n" and get(f"http://{address}/readyz") == "ready\n"
    mesh.tms("stop-process", "tms:db")
    try:

        def reason() -> str:
            try:
                return get(f"http://{address}/readyz")
            except urllib.error.HTTPError as error:
                with error:
                    return f"{error.code} {error.read().decode()}"

        wait_until(
            lambda: reason().startswith('503 WAITING_FOR process="tms:db"'), 30, "the scheduler says what it lacks"
        )
        assert get(f"http://{address}/healthz") == "ok\n"
    finally:
        mesh.tms("start", "tms:db")
        wait_until(lambda: mesh.tms("status", expect=None).returncode == 0, 30, "all is well again", every=CLI)


def test_the_log_of_a_goal_names_process_machine_run_and_goal(mesh: Mesh) -> None:
    mesh.tms("run", "5", "--wait", "--json")
    lines = (mesh.state / "log" / "tms.ts.log").read_text(encoding="utf-8").splitlines()
    reported = [line for line in lines if "event=run" in line and "success" in line]
    assert reported and all(
        re.search(r"process=tms:ts run=\S+ goal=[0-9a-f]{32} event=run", line) for line in reported
    ), reported[-1:]


def test_diagnostics_tell_every_process(mesh: Mesh, node: Ros) -> None:
    received = threading.Event()
    names: set[str] = set()

    def receive(message: Any) -> None:
        names.update(status.name for status in message.status)
        received.set()

    node.subscribe(DiagnosticArray, "/diagnostics", receive, depth=10)
    assert received.wait(15)
    assert {"tms: tms:ts", "tms: zx200:rc", "tms: zx200:rp"} <= names


def test_where_machines_are_is_stored_once_a_second_with_its_age(mesh: Mesh) -> None:
    """The simulated machine publishes pose and joints some 50 times as often."""
    site = load_site(str(mesh.site))
    db = store.connect(store_address.uri(site), site.file.store.database)

    def newest(collection: str) -> list[Any]:
        return list(db[collection].find({"name": "zx200"}).sort("time", -1).limit(4))

    def age(row: Any) -> float:
        return (utc_now() - datetime.fromisoformat(row["time"])).total_seconds()

    try:
        for collection in ("machine_pose", "machine_joints"):
            wait_until(lambda name=collection: len(newest(name)) == 4, 30, f"four of {collection}")  # type: ignore[misc]
            wait_until(lambda name=collection: age(newest(name)[0]) < 3.0, 30, f"a fresh {collection}")  # type: ignore[misc]
            rows = newest(collection)
            assert age(rows[-1]) - age(rows[0]) > 1.5, "four looks take three seconds, less what a busy PC is late"
            assert {(row["type"], row["id"]) for row in rows} == {(collection, 3012)}
        joints = newest("machine_joints")[0]["msg"]
        assert len(joints["name"]) == len(joints["position"]) > 3
        stamp = newest("machine_pose")[0]["msg"]["header"]["stamp"]
        assert abs(utc_now().timestamp() - stamp["sec"]) < 10.0, "when it was measured is told, too"
    finally:
        db.client.close()
