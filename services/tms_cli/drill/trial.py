"""One trial of the drill: hit a process while a leaf moves the machine, watch, and see that the run goes on."""

import os
import signal
import time
from collections.abc import Callable

from tms_cli import mesh
from tms_cli.drill.eyes import Eyes
from tms_cli.drill.rows import FREEZE, KILL, Case, Row
from tms_cli.drill.work import Work
from tms_core.config import Site
from tms_core.errors import TmsError
from tms_core.processes import find
from tms_host.supervisor import Supervisor

TOLD_LIMIT = 3.0  # s for the machine to be told to stop
STAND_LIMIT = 6.0  # s for it to stand
RECEIPT_LIMIT = 10.0  # s for a receipt: a lost gateway's comes from its successor
FROZEN = 2.0  # s that a process stays frozen
BACK_LIMIT = 20.0  # s for the process to be back
GO_ON_LIMIT = 30.0  # s for the run to go on, or to end
UNHARMED = 1.0  # s that the motion must go on when a process that does not stand behind it is lost
SCHEDULER = "tms:ts"


class Trial:
    """Has everything that a case needs; used for one case after another."""

    def __init__(self, site: Site, machine: str, eyes: Eyes, work: Work) -> None:
        self._site, self._machine, self._eyes, self._work = site, machine, eyes, work

    def run(self, case: Case, node: str) -> Row | None:
        """What was seen; None when the motion was over by itself before it could be stopped.

        Raises:
            TmsError: the process does not run.
        """
        row = Row(case.process, node, case.how, self._machine, case.stops)
        pid = self._pid(case.process)
        if not pid:
            raise TmsError(f"{case.process} does not run: see `tms ps`")
        self._eyes.mark()
        hit = time.monotonic()
        self._hit(case, pid)
        self._watch(case, row, hit)
        row.back_s = self._back(case, pid, hit)
        if case.process == SCHEDULER and case.how != FREEZE:
            self._work.scheduler_lost()
        self._work.losses += case.stops
        if case.stops and row.kill_to_stop_s is None and self._eyes.arrived:
            return None
        if row.confirmed and case.stops:
            self._take_receipt(row)
        row.outcome = self._outcome(row.outcome)
        return row

    def _pid(self, name: str) -> int:
        return next((row.pid for row in Supervisor(self._site).processes() if row.name == name), 0)

    def _hit(self, case: Case, pid: int) -> None:
        if case.how == KILL:
            os.kill(pid, signal.SIGKILL)
        elif case.how == FREEZE:
            os.kill(pid, signal.SIGSTOP)
        else:
            Supervisor(self._site).control("restart", case.process)

    def _watch(self, case: Case, row: Row, hit: float) -> None:
        if not case.stops:
            row.confirmed = self._eyes.unharmed(UNHARMED)  # nothing had to stop, and nothing did
            return
        told = self._eyes.wait_told(TOLD_LIMIT)
        if told is None:
            return
        row.kill_to_stop_s = round(told - hit, 3)
        stood = self._eyes.wait_standing(STAND_LIMIT)
        if stood is not None:
            row.confirmed, row.stop_s = True, round(max(0.0, stood - told), 3)
            row.travel = round(self._eyes.travel, 4)

    def _take_receipt(self, row: Row) -> None:
        """A stop counts as confirmed when the gateway says so as well."""
        receipts = self._eyes.wait_receipts(RECEIPT_LIMIT)
        row.confirmed = bool(receipts) and all(receipt.confirmed for receipt in receipts)
        row.receipt = "; ".join(
            f"{'confirmed' if one.confirmed else 'NOT CONFIRMED: ' + one.detail} {one.seconds:.2f} s ({one.cause})"
            for one in receipts
        )

    def _back(self, case: Case, pid: int, hit: float) -> float | None:
        if case.how == FREEZE:
            time.sleep(max(0.0, FROZEN - (time.monotonic() - hit)))
            os.kill(pid, signal.SIGCONT)
        process = find(self._site, case.process)

        def there() -> bool:
            new = self._pid(case.process)
            changed = bool(new) and (new != pid or case.how == FREEZE)
            return changed and (not process.ours or mesh.unready(process) is None)

        return round(time.monotonic() - hit, 3) if _wait(there, BACK_LIMIT) else None

    def _outcome(self, otherwise: str) -> str:
        """The run goes on, with the machine moving; or it has ended, or waits to be resumed."""
        found: list[str] = []

        def over() -> bool:
            ended = self._work.outcome()
            if ended:
                found.append(ended)
            elif self._eyes.moving():
                found.append("goes on")
            elif self._work.interrupted():
                found.append("interrupted")
            return bool(found)

        return found[0] if _wait(over, GO_ON_LIMIT) else otherwise


def _wait(holds: Callable[[], bool], seconds: float) -> bool:
    deadline = time.monotonic() + seconds
    while not holds():
        if time.monotonic() > deadline:
            return False
        time.sleep(0.02)
    return True
