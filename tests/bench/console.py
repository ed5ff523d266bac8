"""What a person at the console feels: five runs whose nodes change twice a second, in a real mesh and a real Chromium.

From a node's change, by the scheduler's clock, to the picture: the page itself takes the time when the state of a node
is in the document and painted. The floor is an answer of the same server to the same page. The cost of consoles is the
processor time of `tms:ur` with twenty of them less that without; its floor is the latter. A press of the stop beside
connections that hang is compared with the same press without them. The site in 3D, large trees and the editor are in
rig/space.py, rig/trees.py and rig/findings.py.
"""

from __future__ import annotations

import json
import socket
import tempfile
import threading
import time
import urllib.request
from collections.abc import Iterable, Iterator
from contextlib import ExitStack, contextmanager
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

import psutil
import yaml

from bench.rig.findings import findings
from bench.rig.space import space
from bench.rig.trees import trees
from bench.runner import Figure
from conftest import Mesh, claimed_domain, ports_of, site_data
from hanging import hanging

if TYPE_CHECKING:
    from playwright.sync_api import Page

RUNS, CONSOLES, SECONDS, ROUNDS = 5, 20, 10, 20
HANGING, PRESSES = 1000, 5
TREE = """<root main_tree_to_execute="M"><BehaviorTree ID="M"><KeepRunningUntilFailure><Sequence name="run {number}">
<Delay delay_msec="500"><AlwaysSuccess name="a"/></Delay><Delay delay_msec="500"><AlwaysSuccess name="b"/></Delay>
</Sequence></KeepRunningUntilFailure></BehaviorTree></root>"""
# Notes when each node became running in the document, at the next frame.
WATCH = """() => {
  window.seen = [];
  new MutationObserver((changes) => requestAnimationFrame(() => {
    const now = Date.now() / 1000;
    for (const { target } of changes) {
      if (target.dataset.state === "running") window.seen.push([target.dataset.path, now]);
    }
  })).observe(document.getElementById("tree_box"),
    { subtree: true, attributes: true, attributeFilter: ["data-state"] });
}"""
PING = """async (rounds) => {
  const times = [];
  for (let i = 0; i < rounds; i += 1) {
    const begun = performance.now();
    await (await fetch("/api/session")).json();
    times.push(performance.now() - begun);
  }
  return times.sort((a, b) => a - b)[Math.floor(rounds * 0.95)];
}"""


def measure() -> Iterable[Figure]:
    with ExitStack() as stack:
        domain, folder = stack.enter_context(claimed_domain()), Path(stack.enter_context(tempfile.TemporaryDirectory()))
        yield space(folder)  # before the mesh takes processor time
        yield from trees(folder)
        port = ports_of(domain)
        site = folder / "site.yaml"
        site.write_text(yaml.safe_dump(site_data(domain, port)))
        mesh = Mesh(site, folder / "state")
        stack.callback(mesh.tms, "down")
        mesh.tms("up")
        mesh.arm()
        mesh.tms("param", "load", "configs/parameters/zx200.yaml")
        address = f"http://127.0.0.1:{port + 90}"
        yield findings(mesh, folder, address, PING)
        runs = [_start(mesh, folder, number) for number in range(RUNS)]
        yield from _pages(address, runs[0])
        yield _consoles(mesh, port + 90)
        yield _press(port + 90)


def _start(mesh: Mesh, folder: Path, number: int) -> str:
    file = folder / f"{number}.xml"
    file.write_text(TREE.format(number=number))
    task = json.loads(mesh.tms("task", "add", str(file), "--json").stdout)["task_id"]
    return str(json.loads(mesh.tms("run", str(task), "--json").stdout)["run_id"])


def _pages(address: str, run: str) -> Iterator[Figure]:
    from browsers import chromium

    with chromium() as browser:
        yield from _page(browser.new_page(locale="en-GB"), address, run)


def _page(page: Page, address: str, run: str) -> Iterator[Figure]:
    sizes: list[int] = []
    page.on("response", lambda answer: sizes.append(int(answer.headers.get("content-length", 0))))
    page.goto(f"{address}/icon.svg")
    floor = _opened(page, f"{address}/icon.svg", "svg")
    sizes.clear()
    usable = _opened(page, f"{address}/#board", "#list_tasks li")
    yield Figure("first page", "KB", sum(sizes) / 1000, 150.0, (sizes[0] or 1) / 1000)
    yield Figure("first page usable", "ms", usable, 700.0, floor, usual_floor=60.0)
    page.goto(f"{address}/#tree/{run}")
    page.wait_for_selector("#tree_box [data-state=running]")
    page.evaluate(WATCH)
    time.sleep(SECONDS)
    delays = sorted(_delays(page.evaluate("window.seen"), _journal(address, run)))
    yield Figure("node to pixel p95", "ms", delays[int(len(delays) * 0.95)] * 1000, 150.0, page.evaluate(PING, ROUNDS),
                 usual_floor=20.0)  # fmt: skip


def _opened(page: Page, url: str, selector: str) -> float:
    begun = time.perf_counter()
    page.goto(url)
    page.wait_for_selector(selector)
    return (time.perf_counter() - begun) * 1000


def _journal(address: str, run: str) -> list[tuple[str, float]]:
    """(path, time) of every node that became running."""
    found: list[dict[str, Any]] = []
    while True:
        after = found[-1]["number"] if found else 0
        with urllib.request.urlopen(f"{address}/api/runs/{run}/events?after={after}", timeout=30) as answer:
            page = json.load(answer)
        found += page
        if len(page) < 1000:
            break
    changes = [event for event in found if event["kind"] == "node" and event["reason"]["args"].get("new") == "RUNNING"]
    return [(event["node"], datetime.fromisoformat(event["stamp"].replace("Z", "+00:00")).timestamp())
            for event in changes]  # fmt: skip


def _delays(seen: list[tuple[str, float]], reported: list[tuple[str, float]]) -> Iterator[float]:
    """From the last change of that node before it was seen; nodes change twice a second, so none is mistaken."""
    for path, at in seen:
        before = [stamp for node, stamp in reported if node == path and stamp <= at]
        if before:
            yield at - before[-1]


def _consoles(mesh: Mesh, port: int) -> Figure:
    rows = json.loads(mesh.tms("ps", "--json").stdout)
    rows = rows if isinstance(rows, list) else rows["processes"]
    server = psutil.Process(next(row["pid"] for row in rows if row["name"] == "tms:ur"))
    floor = _load(server)
    with consoles(port):
        time.sleep(2)
        busy = _load(server)
    return Figure(f"{CONSOLES} consoles", "%", busy - floor, 10.0, floor)


def _press(port: int) -> Figure:
    """The longest of some presses of the stop, answered with the proof that the machine stands."""
    floor = _most(port)
    with hanging(port, HANGING):
        return Figure(f"press beside {HANGING} hanging", "ms", _most(port), 1000.0, floor, usual_floor=250.0)


def _most(port: int) -> float:
    return max(_pressed(port) for _ in range(PRESSES))


def _pressed(port: int) -> float:
    request = urllib.request.Request(f"http://127.0.0.1:{port}/api/stop", b"{}", {"Content-Type": "application/json"})
    begun = time.perf_counter()
    with urllib.request.urlopen(request, timeout=30) as answer:
        assert all(receipt["confirmed"] for receipt in json.load(answer))
    return (time.perf_counter() - begun) * 1000


def _load(process: psutil.Process) -> float:
    """Per cent of a core."""
    before, begun = sum(process.cpu_times()[:2]), time.monotonic()
    time.sleep(SECONDS)
    return (sum(process.cpu_times()[:2]) - before) / (time.monotonic() - begun) * 100


@contextmanager
def consoles(port: int) -> Iterator[None]:
    """CONSOLES that hear everything."""
    leave = threading.Event()
    threads = [threading.Thread(target=_look, args=(port, leave), daemon=True) for _ in range(CONSOLES)]
    for thread in threads:
        thread.start()
    try:
        yield
    finally:
        leave.set()
        for thread in threads:
            thread.join(10)


def _look(port: int, leave: threading.Event) -> None:
    with socket.create_connection(("127.0.0.1", port), 10) as console:
        console.sendall(f"GET /api/events HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n".encode())
        while not leave.is_set():
            console.recv(262_144)
