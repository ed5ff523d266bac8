"""How many machines four PCs carry, each with a scheduler of its own; for `make fleet` (SIZES of it in TMS_FLEET).

The figures are told and not asserted: all four containers, and the machines, share the processors of this PC.
"""

import os
import time

import psutil
import pytest
from fleet import Fleet, press

from bench.rig.costs import pss
from bench.scale import RUNS, SETTLE, watched

pytestmark = [pytest.mark.docker, pytest.mark.timeout(600, func_only=True)]
SIZES = [int(size) for size in os.environ.get("TMS_FLEET", "").split()]


@pytest.mark.parametrize("fleet", SIZES, indirect=True)
def test_every_run_goes_and_every_machine_is_stopped(fleet: Fleet, capsys: pytest.CaptureFixture[str]) -> None:
    machines = sum(map(len, fleet.shares.values()))
    with fleet.crowds() as crowds, fleet.going(RUNS, crowds) as dispatcher:
        time.sleep(SETTLE)
        psutil.cpu_percent()
        rows = fleet.schedulers
        found = dict(zip(rows, watched(rows), strict=True))
        busy = psutil.cpu_percent()
        memory = {row: pss(pid) for row, pid in rows.items()}
        heard, ended, left = press(dispatcher, crowds)
    with capsys.disabled():
        print(f"\n{machines} machines on 4 PCs, {RUNS} runs; processors of this PC {busy:.0f} % busy")
        for row, (late, handed_over, slow, cpu) in found.items():
            print(
                f"  {row.full:12} ticks late {late:5.2f} %, hand-over {handed_over:6.1f} ms, over 250 ms {slow:5.1f} %,"
                f" {cpu:5.1f} % of a core, {memory[row]:4.0f} MB"
            )
        print(f"  stop heard after {heard:.1f} ms, last goal asked to end after {ended:.0f} ms, {left} runs left")
    assert left == 0
