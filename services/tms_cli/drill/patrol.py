"""Goes through the cases while one endless run works: whatever leaf is RUNNING, a case of that leaf is next.

A run that goes on after every loss is what a site wants to see, and no time is lost with bringing the machine to a
leaf again and again.
"""

import time
from collections import Counter
from collections.abc import Sequence

import click

from tms_cli.drill.eyes import Eyes
from tms_cli.drill.report import line
from tms_cli.drill.rows import LEFT_OUT, Case, Row, choose
from tms_cli.drill.trial import Trial
from tms_cli.drill.work import Work
from tms_core.errors import TmsError

STALL_LIMIT = 90.0  # s without a case that fits; a cycle of the task takes about 25 s
LOOK = 0.01  # s
AGAIN = 20  # times that a case, in all rounds, is tried again because its motion was over too early


class Patrol:
    """Keeps the run going and collects what was seen."""

    def __init__(self, machine: str, paths: Sequence[str], retries: int, eyes: Eyes, work: Work, trial: Trial) -> None:
        self._machine, self._paths, self._retries = machine, paths, retries
        self._eyes, self._work, self._trial = eyes, work, trial
        self.rows: list[Row] = []

    def walk(self, cases: Sequence[Case], seconds: float) -> list[Row]:
        """Try all cases, or as many as the time allows."""
        todo, total = list(cases), len(cases)
        early: Counter[Case] = Counter()
        deadline = time.monotonic() + seconds
        while todo and time.monotonic() < deadline:
            case = self._next(todo, deadline)
            if case is None:
                break
            todo.remove(case)
            row = self._try(case)
            if row is None and early[case] < AGAIN:
                early[case] += 1
                todo.append(case)
                continue
            self.rows.append(row or self._left_out(case))
            click.echo(f"{len(self.rows)}/{total} {line(self.rows[-1])}", err=True)
        self._end()
        return [*self.rows, *(self._left_out(case) for case in todo)]

    def _try(self, case: Case) -> Row | None:
        try:
            return self._trial.run(case, self._paths[case.leaf])
        except (TmsError, ProcessLookupError) as error:
            click.echo(f"{case.process} {case.how}: {error}", err=True)
            return self._row(case)

    def _next(self, todo: Sequence[Case], deadline: float) -> Case | None:
        """Wait for a moment that fits one of the cases; None when none comes."""
        stalled = min(deadline, time.monotonic() + STALL_LIMIT)
        while time.monotonic() < stalled:
            if not self._keeps_going():
                return None
            if self._eyes.moving():
                case = choose(todo, self._work.leaf, self._eyes.fresh() and self._work.losses < self._retries)
                if case is not None:
                    return case
            time.sleep(LOOK)
        click.echo("no leaf that is left to try comes to move the machine: see `tms events last`", err=True)
        return None

    def _keeps_going(self) -> bool:
        """Begin when nothing runs; resume what was interrupted. What was seen so far outlives a mesh that cannot."""
        try:
            if self._work.lost and self._work.interrupted():
                self._work.begin(resume=True)
            elif self._work.idle():
                self._work.begin()
        except TmsError as error:
            click.echo(f"the run does not go on, the rest is left out: {error}", err=True)
            return False
        return True

    def _end(self) -> None:
        try:
            self._work.end()
        except TmsError as error:
            click.echo(f"the run was not ended: {error}", err=True)

    def _row(self, case: Case) -> Row:
        return Row(case.process, self._paths[case.leaf], case.how, self._machine, case.stops)

    def _left_out(self, case: Case) -> Row:
        row = self._row(case)
        row.outcome = LEFT_OUT
        return row
