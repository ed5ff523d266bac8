"""The program: options, the scenario, the table, the exit code."""

from __future__ import annotations

import signal
import sys
import time
import traceback

import browsers
from bench.runner import commit
from tms_config.clock import utc_now
from verify import report, scenario
from verify.place import PROJECT, place

FOLDER = PROJECT / ".state" / "verification"


def main() -> int:
    signal.signal(signal.SIGTERM, lambda _number, _frame: sys.exit(1))  # so that no mesh is left behind
    book, begun, unfinished = report.Book(), time.monotonic(), False
    try:
        with place() as site, browsers.chromium() as browser:
            print(f"the mesh is up after {time.monotonic() - begun:.0f} s", flush=True)
            scenario.play(book, site, browser)
    except Exception:
        traceback.print_exc()
        unfinished = True
    rows, seconds = book.rows(unfinished), time.monotonic() - begun
    report.write(FOLDER, rows, commit(), utc_now().isoformat(timespec="seconds"), seconds)
    print(report.terminal(rows))
    held = sum(row.held for row in rows)
    print(f"{held} held, {len(rows) - held} failed, {seconds:.0f} s; kept in {FOLDER.relative_to(PROJECT)}/")
    return report.exit_code(rows)
