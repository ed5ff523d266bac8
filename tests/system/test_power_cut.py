"""The power goes while a machine moves, and the disk stalls: what was told stays true, and nothing stops for nothing.

A mesh on a disk of its own; needs root. `make nightly` cuts the power 30 times (TMS_POWER_CUTS).
"""

import json
import os
import threading
import time
from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import pytest
import yaml
from test_mesh import events, newest, run
from test_stop import rearm, state_of
from tms_msg_rc.msg import MachineState
from tms_msg_ts.srv import CancelRun

from conftest import CLI, NO_CONSOLE, PROJECT, Mesh, claimed_domain, node_in, ports_of, running, site_data, wait_until
from power_cut import Disk, family, own_disk
from programs import Program, running_tms
from tms_ros.node import Ros
from words import words

pytestmark = [pytest.mark.turns, pytest.mark.system]
CUTS = int(os.environ.get("TMS_POWER_CUTS", "3"))
STALL = 2.0  # s
STARVED, ATTEMPTS = 3.0, 3  # s that a thread waits for a processor: DDS drops who is silent for 5
STANDING = 1.5  # s; between two swings it stands for a moment only


@pytest.fixture(scope="module")
def disk(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Disk]:
    with own_disk(tmp_path_factory.mktemp("power")) as made:
        yield made


@pytest.fixture(scope="module")
def mesh(disk: Disk) -> Iterator[Mesh]:
    """A mesh whose state is on the disk; the site file is not."""
    with claimed_domain() as domain:
        site = disk.folder.parent / "site.yaml"
        site.write_text(yaml.safe_dump(site_data(domain, ports_of(domain), **NO_CONSOLE)))
        state, logs = disk.folder / "state", disk.folder.parent / "ros"
        for folder in (state, logs):
            folder.mkdir()
        (state / "ros").symlink_to(logs)  # rclpy's logs, also of those who outlive the power cut
        os.sync()
        with running(Mesh(site, state)) as made:
            made.tms("param", "load", "configs/parameters/zx200.yaml")
            made.tms("task", "add", str(PROJECT / "tests" / "data" / "one_move.xml"))
            made.tms("param", "load", str(PROJECT / "tests" / "data" / "swings.yaml"))
            swings = (PROJECT / "tests" / "data" / "swings.xml").read_text()
            endless = disk.folder.parent / "endless.xml"  # also on a busy PC, where every look takes a second
            endless.write_text(swings.replace('num_cycles="8"', 'num_cycles="1000"'))
            made.tms("task", "add", str(endless))
            run(made, "1")
            yield made


@pytest.fixture(scope="module")
def node(mesh: Mesh) -> Iterator[Ros]:
    with node_in(mesh) as inside:
        yield inside


@contextmanager
def swinging(mesh: Mesh, leaves: int = 2) -> Iterator[Program]:
    """A client that runs the swings; inside, so many of them have begun."""
    before = newest(mesh)
    with running_tms("run", "2", "--wait", "--json", env=mesh.env) as client:
        wait_until(lambda: newest(mesh) != before, 60, "the run has begun", every=CLI)
        run_id = newest(mesh)
        wait_until(lambda: goals(mesh, run_id) >= leaves, 60, "the machine moves", every=CLI)
        yield client


def goals(mesh: Mesh, run_id: str) -> int:
    return sum("accepted" in row["text"] for row in events(mesh, run_id))


History = dict[str, tuple[dict[str, Any], list[dict[str, Any]]]]  # run and events by id


def history(mesh: Mesh) -> History:
    """All that the history tells."""
    rows = json.loads(mesh.tms("runs", "--json").stdout)
    return {row["run_id"]: (row, events(mesh, row["run_id"])) for row in rows}


class Reader:
    """Asks for the events of a run again and again, until the power goes."""

    def __init__(self, mesh: Mesh, run_id: str) -> None:
        self._mesh, self._run_id = mesh, run_id
        self.reported: list[dict[str, Any]] = []
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._read)
        self._thread.start()

    def _read(self) -> None:
        while not self._closing.is_set():
            done = self._mesh.tms("events", self._run_id, "--json", expect=None)
            if done.returncode:
                return
            self.reported = json.loads(done.stdout)

    def close(self) -> None:
        self._closing.set()
        self._thread.join(60)


@pytest.mark.timeout(240 * CUTS)
def test_after_a_power_cut_everything_that_was_told_is_there_and_nothing_is_claimed(mesh: Mesh, disk: Disk) -> None:
    for moment in range(CUTS):
        before, reported, run_id = cut(mesh, disk, 1 + moment % 5)
        mesh.tms("up")
        mesh.wait_ready()
        closed_as_told(mesh, before, reported, run_id)
        wait_latched(mesh, run_id)
        mesh.tms("abandon", run_id)
        rearm(mesh)
        assert run(mesh, "1")["outcome"] == "success"


def cut(mesh: Mesh, disk: Disk, leaves: int) -> tuple[History, list[dict[str, Any]], str]:
    """Cut the power in the middle of a run; returns what the history told before, and the run's last told events."""
    with swinging(mesh, leaves):
        before, run_id = history(mesh), newest(mesh)
        reader = Reader(mesh, run_id)
        wait_until(lambda: bool(reader.reported), 60, "the reader has begun")
        disk.cut(family(int((mesh.state / "supervisord.pid").read_text())))
        reader.close()
    return before, reader.reported, run_id


def closed_as_told(mesh: Mesh, before: History, reported: list[dict[str, Any]], run_id: str) -> None:
    wait_until(lambda: state_of(mesh, run_id) == "interrupted", 60, "the run is closed as interrupted", every=CLI)
    after = history(mesh)
    for known, (row, rows) in before.items():
        assert after[known][1][: len(rows)] == rows
        assert known == run_id or after[known][0] == row
    kept = after[run_id][1]
    assert len(reported) >= len(before[run_id][1]) and kept[: len(reported)] == reported
    assert [row["number"] for row in kept] == sorted({row["number"] for row in kept})
    claims_what_receipts_say(after[run_id][0]["reason"], kept[len(reported) :])


def claims_what_receipts_say(reason: str, new: list[dict[str, Any]]) -> None:
    stood = any(row["kind"] == "stop" and row["text"].startswith("zx200 stood after") for row in new)
    if stood:
        assert "; seen to stand: zx200" in reason
    else:
        assert "; not seen to stand: zx200" in reason
        assert any(row["kind"] == "alarm" and row["text"].startswith("zx200: not seen to stand") for row in new)


def wait_latched(mesh: Mesh, run_id: str) -> None:
    wait_until(lambda: f"restarted while {run_id} held it" in latch(mesh), 30, "the machine is latched")


def latch(mesh: Mesh) -> str:
    """The cause of the latch as the disk has it, empty if the machine is armed."""
    folder = Path(mesh.state, "rc")
    if (folder / "zx200.armed").exists():
        return ""
    return words(str(json.loads((folder / "zx200.latched").read_text())["cause"]))


def test_a_disk_that_stalls_stops_nothing_and_loses_nothing(mesh: Mesh, disk: Disk) -> None:
    for _ in range(ATTEMPTS):
        delays = Delays(int((mesh.state / "supervisord.pid").read_text()))
        rows = run_beside_stalls(mesh, disk)
        assert [row["number"] for row in rows] == list(range(1, len(rows) + 1))
        lost = [row["text"] for row in rows if row["kind"] in ("loss", "alarm")]
        if not lost or delays.longest() < STARVED:
            break
    assert not lost, f"nobody waited for a processor for more than {delays.longest():.1f} s"
    asked = next(row["number"] for row in rows if row["text"].startswith("stopping"))
    assert all(row["number"] > asked for row in rows if row["kind"] == "stop")


class Delays:
    """How long threads of a mesh have waited for a processor since this was made: a busy PC loses what no disk does."""

    def __init__(self, supervisord: int) -> None:
        self._supervisord = supervisord
        self._before = self._waited()

    def _waited(self) -> dict[str, float]:
        found = {}
        for pid in family(self._supervisord):
            with suppress(OSError):  # it has ended
                for thread in Path(f"/proc/{pid}/task").iterdir():
                    found[str(thread)] = int((thread / "schedstat").read_text().split()[1]) * 1e-9
        return found

    def longest(self) -> float:
        return max(waited - self._before.get(thread, 0.0) for thread, waited in self._waited().items())


def run_beside_stalls(mesh: Mesh, disk: Disk) -> list[dict[str, Any]]:
    """The events of a run that is cancelled after the disk has stalled twice."""
    with swinging(mesh) as client:
        run_id = newest(mesh)
        for _ in range(2):
            with disk.stalled():
                time.sleep(STALL)  # the fault itself
        known = goals(mesh, run_id)
        wait_until(lambda: goals(mesh, run_id) > known, 60, "the run goes on", every=CLI)
        mesh.tms("cancel", run_id)
        out = client.output(60)
    assert json.loads(out)["outcome"] == "cancelled"
    return events(mesh, run_id)


def test_a_run_is_stopped_while_the_disk_stalls(mesh: Mesh, disk: Disk, node: Ros) -> None:
    """Its receipt comes when the gateway could note on the disk how the machine was left; it stands long before."""
    received: deque[tuple[float, bool]] = deque(maxlen=1000)  # monotonic time, whether it moved

    def stands() -> bool:
        now = time.monotonic()
        last = [moved for at, moved in received if now - at < STANDING]
        return len(last) > 1 and not any(last) and now - received[0][0] > STANDING

    with swinging(mesh) as client:
        run_id = newest(mesh)
        receive = lambda state: received.append((time.monotonic(), state.moving))  # noqa: E731
        listening = node.subscribe(MachineState, "/zx200/rc/state", receive, latched=True)
        try:
            with disk.stalled():
                node.call(CancelRun, "/tms/cancel_run", CancelRun.Request(run_id=run_id))
                received.clear()
                wait_until(stands, 20, "the machine stands")
        finally:
            node.node.destroy_subscription(listening)
        out = client.output(60)
    assert json.loads(out)["outcome"] == "cancelled"
    stops = [row["text"] for row in events(mesh, run_id) if row["kind"] == "stop"]
    assert stops and all(text.startswith("zx200 stood after") for text in stops)
