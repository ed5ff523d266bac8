"""`make soak MINUTES=n`: an excavator and two trucks move earth, job after job, in a site with areas, twice as fast as
real ones, while a sensing PC publishes and each minute a process is killed.

Exit code 1 when a job fails or is done twice, a process ended by itself, the memory, handles or threads of one grew
from the first third of the time to the last, a receipt was false, or a tick took longer than 250 ms without a kill.
"""

from __future__ import annotations

import argparse
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]
sys.path[0:1] = [str(TESTS), str(TESTS.parent / "services")]

import yaml  # noqa: E402

import earth_job  # noqa: E402
from bench.rig.mesh import Rig, rig  # noqa: E402
from soak import reading  # noqa: E402
from soak.growth import WARM, Growth, growth, table  # noqa: E402
from soak.kills import KILLED, PERIOD, Kills  # noqa: E402
from soak.receipts import Receipts  # noqa: E402
from soak.ticks import LATE, Ticks  # noqa: E402
from soak.work import Failed, Work, start  # noqa: E402
from tms_config.processes import find  # noqa: E402
from tms_host.supervisor import Supervisor  # noqa: E402

SPEED = 2.0  # times real time: faster than that no gateway with areas believes a pose
LOOK = 2.0  # s between two looks at the ticks and receipts
SAMPLE = 20.0  # s between two looks at what processes hold
LONG = WARM + 3 * len(KILLED) * PERIOD  # s; else a third of them does not see each process at every age
SERVICES: dict[str, object] = {"db": {}, "ts": {}, "sp": {}, "host": {}}


class Watch:
    """Looks at everything while the work goes on, and kills; in a thread of its own."""

    def __init__(self, own: Rig, kills: Kills, receipts: Receipts) -> None:
        supervisor = Supervisor(own.site)
        self.kills, self.receipts = kills, receipts
        self.growth, self.ticks = Growth(supervisor), Ticks(find(own.site, "tms:ts"))
        self._leave = threading.Event()
        self._pool = ThreadPoolExecutor(1)

    def __enter__(self) -> Watch:
        self._watching = self._pool.submit(self._watch)
        return self

    def __exit__(self, *_: object) -> None:
        self._leave.set()
        self._pool.shutdown()
        self._watching.result()  # nothing counts as seen if it broke off
        self.receipts.judge(0.0)

    def _watch(self) -> None:
        duties: list[tuple[float, Callable[[], object]]] = [
            (LOOK, self.ticks.look), (LOOK, self.receipts.judge), (SAMPLE, self.growth.look), (PERIOD, self._kill),
        ]  # fmt: skip
        due = [time.monotonic() + period for period, _ in duties]
        while not self._leave.wait(max(0.0, min(due) - time.monotonic())):
            for number, (period, duty) in enumerate(duties):
                if time.monotonic() >= due[number]:
                    duty()
                    due[number] += period

    def _kill(self) -> None:
        print(f"{time.strftime('%H:%M:%S')} killed {self.kills.kill()}", flush=True)

    def findings(self) -> list[str]:
        """All that no kill explains."""
        late = [f"{count:.0f} ticks took longer than {LATE} s, at {_clock(at)}"
                for at, count in self.ticks.late if not self.kills.explain_late(at)]  # fmt: skip
        anew = [f"{name} began anew by itself, at {_clock(at)}"
                for at, name in self.growth.restarted if not self.kills.explain_new(at, name)]  # fmt: skip
        false = [f"a false receipt of {told}" for told in self.receipts.false]
        return [*late, *anew, *false]


def _clock(at: float) -> str:
    return time.strftime("%H:%M:%S", time.localtime(at))


@contextmanager
def _readings() -> Iterator[None]:
    """A process that publishes them."""
    words = [sys.executable, "-m", "soak.reading"]
    environment = {**os.environ, "PYTHONPATH": f"{TESTS}:{TESTS.parent / 'services'}"}
    with subprocess.Popen(words, env=environment) as process:
        try:
            yield
            assert process.poll() is None, "the sensing PC has ended"
        finally:
            process.kill()


def main() -> int:
    parser = argparse.ArgumentParser(prog="soak", description=__doc__)
    parser.add_argument("--minutes", type=float, default=120.0)
    signal.signal(signal.SIGTERM, lambda _number, _frame: sys.exit(1))  # so that no mesh is left behind
    seconds = 60 * parser.parse_args().minutes
    changes = {"machines": earth_job.MACHINES, "ground": earth_job.GROUND, "services": SERVICES}
    with rig(sim={"speed": SPEED}, sensing="sensing.yaml", **changes) as own:
        own.mesh.site.with_name("sensing.yaml").write_text(yaml.safe_dump(reading.SENSING))
        record = own.mesh.site.with_name("reading.yaml")
        record.write_text(yaml.safe_dump([reading.RECORD]))
        start(own.mesh)
        own.mesh.tms("param", "load", str(record))
        return _soak(own, seconds)


def _soak(own: Rig, seconds: float) -> int:
    kills = Kills(Supervisor(own.site))
    work, found = Work(own.mesh, kills), list[str]()
    with own.node() as node, _readings(), Watch(own, kills, Receipts(node, own.site, kills)) as watch:
        deadline = time.monotonic() + seconds
        try:
            while time.monotonic() < deadline:
                work.job()
                print(f"{time.strftime('%H:%M:%S')} job {work.jobs} is done", flush=True)
        except (Failed, AssertionError) as error:
            found.append(str(error))
    found += [*work.once(), *watch.findings()]
    long_enough = seconds >= LONG
    found += growth(watch.growth.samples) if long_enough else []
    print(table(watch.growth.samples))
    for line in found:
        print(f"  {line}")
    receipts = watch.receipts
    print(
        f"{work.jobs} jobs, {len(kills.done)} kills, {work.resumed} runs resumed, {receipts.count} receipts, "
        f"{len(receipts.false)} false, {receipts.unconfirmed} unconfirmed: "
        f"{len(found)} findings" + ("" if long_enough else f" (what grows is seen after {LONG / 60:.0f} minutes)")
    )
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
