"""Alarms that a real Prometheus tells, and what is told where it cannot be asked."""

import json
from collections.abc import Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path
from threading import Thread
from typing import Any

import pytest

from conftest import wait_until
from prometheus_server import prometheus
from tms_config.clock import utc_now
from tms_ur.prometheus import AWAY, alarms

CONFIG = {"global": {"evaluation_interval": "5s"}, "rule_files": ["rules.yml"]}


def alert(name: str, **more: Any) -> dict[str, Any]:
    annotations = {"summary": "The disk of {{ $labels.instance }} is nearly full", "summary_ja": "空きがありません"}
    labels, sample = {"severity": "warning"}, 'label_replace(vector(1), "instance", "pc-2", "", "")'
    return {"alert": name, "expr": sample, "labels": labels, "annotations": annotations, **more}


def test_what_fires_and_only_metrics_show_is_told(tmp_path: Path, first_port: int) -> None:
    rules = [
        alert("TmsDiskFilling"), alert("TmsLatchHeld"), alert("TmsSoilError", **{"for": "1h"}),
        alert("TmsStoreDown", labels={"severity": "critical"}),
    ]  # fmt: skip
    (tmp_path / "prometheus.yml").write_text(json.dumps(CONFIG))
    (tmp_path / "rules.yml").write_text(json.dumps({"groups": [{"name": "tms", "rules": rules}]}))
    with prometheus(tmp_path, first_port + 96) as address:
        wait_until(lambda: len(alarms(address, utc_now())) == 2, 30, "two alerts fire")
        disk, store = sorted(alarms(address, utc_now()), key=lambda one: one.name)
    assert (disk.name, disk.severity, disk.subject) == ("TmsDiskFilling", "warning", "pc-2")
    assert (disk.reason.text.en, disk.reason.text.ja) == ("The disk of pc-2 is nearly full", "空きがありません")
    assert (store.name, store.severity) == ("TmsStoreDown", "critical") and disk.since <= utc_now()


@contextmanager
def answering(status: int, body: bytes) -> Iterator[str]:
    """A server that gives everybody the same answer; its address."""

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            self.send_response(status)
            self.end_headers()
            self.wfile.write(body)

        def log_message(self, *_: object) -> None:
            pass

    server = HTTPServer(("127.0.0.1", 0), Handler)
    thread = Thread(target=server.serve_forever)
    thread.start()
    try:
        yield f"http://127.0.0.1:{server.server_port}"
    finally:
        server.shutdown()
        thread.join()
        server.server_close()


@pytest.mark.parametrize(
    ("status", "body"),
    [
        (200, b"<html>"),
        (200, b'{"status": "error"}'),
        (503, b""),
        (200, b'{"status": "success", "data": {"alerts": [{}]}}'),
    ],
)
def test_an_answer_that_is_none_is_an_alarm(status: int, body: bytes) -> None:
    now = utc_now()
    with answering(status, body) as address:
        (told,) = alarms(address, now)
    assert (told.name, told.subject, told.since) == (AWAY, address, now)
    assert address in told.reason.text.en and told.reason.details.en and told.reason.action is not None


def test_a_prometheus_that_is_not_there_is_an_alarm(first_port: int) -> None:
    (told,) = alarms(f"http://127.0.0.1:{first_port + 97}", utc_now())
    assert told.name == AWAY and "refused" in told.reason.details.en
