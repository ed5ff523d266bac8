"""`make soak MINUTES=n`: the two-machine demo over and over at ten times its speed. Nothing may grow or be late.

Exit code 1 when a run fails, a process was restarted, a tick took longer than 250 ms, or the memory, handles or threads
of a process grew from the first third of the time to the last.
"""

from __future__ import annotations

import argparse
import signal
import statistics
import sys
import time
import urllib.request
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

TESTS = Path(__file__).resolve().parent
sys.path[0:1] = [str(TESTS), str(TESTS.parent / "services")]

import psutil  # noqa: E402
from prometheus_client.parser import text_string_to_metric_families  # noqa: E402

from bench.rig.mesh import Rig, rig  # noqa: E402
from tms_config.processes import find  # noqa: E402
from tms_host.supervisor import Supervisor  # noqa: E402

TASK = "configs/tasks/zx200_and_ic120_load_and_haul.xml"
MACHINES = {"zx200": {"model": "zx200"}, "ic120": {"model": "ic120"}}
RECORDS = ("zx200", "ic120", "shared")
SPEED = 10.0
RUN_LIMIT = 300.0  # s
LATE = 0.25  # s; a bucket of tms_ts_tick_seconds
SLACK = {"memory": 3.0, "handles": 2.0, "threads": 2.0}  # MB, count, count: noise of a process that does not grow
PART = 0.03  # of the memory, in addition


@dataclass(frozen=True)
class Sample:
    """What one process holds."""

    pid: int
    memory: float  # MB of its own
    handles: float
    threads: float


def main() -> int:
    parser = argparse.ArgumentParser(prog="soak", description=__doc__)
    parser.add_argument("--minutes", type=float, default=120.0)
    signal.signal(signal.SIGTERM, lambda _number, _frame: sys.exit(1))  # so that no mesh is left behind
    minutes = parser.parse_args().minutes
    with rig(machines=MACHINES, sim={"speed": SPEED}) as own:
        own.mesh.tms("up")
        own.mesh.arm()
        for name in RECORDS:
            own.mesh.tms("param", "load", f"configs/parameters/{name}.yaml")
        own.mesh.tms("task", "add", TASK)
        samples, failed = _repeat(own, time.monotonic() + 60 * minutes)
        late = _late(own)
    found = [*failed, *growth(samples), *([f"{late:.0f} ticks took longer than {LATE} s"] if late else [])]
    runs = max(map(len, samples.values()), default=0)
    print(table(samples))
    for line in found:
        print(f"  {line}")
    print(f"{runs} runs, {len(samples)} processes: {'nothing grew' if not found else f'{len(found)} findings'}")
    return 1 if found or runs < 3 else 0


def _repeat(own: Rig, until: float) -> tuple[dict[str, list[Sample]], list[str]]:
    """Run the task until the time is over; the samples after each run, and what went wrong."""
    samples: dict[str, list[Sample]] = defaultdict(list)
    supervisor = Supervisor(own.site)
    while time.monotonic() < until:
        done = own.mesh.tms("run", "1", "--wait", expect=None, limit=RUN_LIMIT)
        for row in supervisor.processes():
            if row.pid and row.name != "tms:store":
                samples[row.name].append(_sample(row.pid))
        print(f"run {max(map(len, samples.values()))}: exit code {done.returncode}", flush=True)
        if done.returncode:
            return samples, [f"a run failed: {(done.stderr or done.stdout).strip().splitlines()[-1]}"]
    return samples, []


def _sample(pid: int) -> Sample:
    process = psutil.Process(pid)
    return Sample(pid, process.memory_full_info().uss / 1e6, process.num_fds(), process.num_threads())


def _ends(rows: list[Sample], what: str) -> tuple[float, float]:
    """Medians of the first third (but the very first, before caches are warm) and of the last."""
    third = max(1, len(rows) // 3)
    first, last = rows[1 : third + 1] or rows[:1], rows[-third:]
    before, after = (statistics.median(getattr(row, what) for row in part) for part in (first, last))
    return before, after


def table(samples: dict[str, list[Sample]]) -> str:
    """What each process held in the first third of the time and in the last."""
    lines = [f"{'process':<24}{'memory [MB]':>18}{'handles':>14}{'threads':>14}"]
    for name, rows in sorted(samples.items()):
        memory, handles, threads = (_ends(rows, what) for what in SLACK)
        lines.append(
            f"{name:<24}{memory[0]:>8.1f} -> {memory[1]:<6.1f}{handles[0]:>6.0f} -> {handles[1]:<4.0f}"
            f"{threads[0]:>6.0f} -> {threads[1]:<4.0f}"
        )
    return "\n".join(lines)


def growth(samples: dict[str, list[Sample]]) -> list[str]:
    """What grew from the first third of the samples to the last."""
    found = []
    for name, rows in sorted(samples.items()):
        if len({row.pid for row in rows}) > 1:
            found.append(f"{name} was restarted")
            continue
        for what, slack in SLACK.items():
            before, after = _ends(rows, what)
            allowed = before + slack + (PART * before if what == "memory" else 0)
            if after > allowed:
                found.append(f"{name}: {what} grew from {before:.1f} to {after:.1f}, allowed are {allowed:.1f}")
    return found


def _late(own: Rig) -> float:
    """Ticks longer than LATE, as the scheduler counted them."""
    port = find(own.site, "tms:ts").port
    with urllib.request.urlopen(f"http://{own.site.file.bind}:{port}/metrics", timeout=10) as answer:
        families = text_string_to_metric_families(answer.read().decode())
    ticks = next(family for family in families if family.name == "tms_ts_tick_seconds")
    by_limit = {each.labels["le"]: each.value for each in ticks.samples if each.name.endswith("_bucket")}
    return by_limit["+Inf"] - by_limit[str(LATE)]


if __name__ == "__main__":
    sys.exit(main())
