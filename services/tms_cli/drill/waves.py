"""Waves of trials: all machines move, each is hit, and all stop again."""

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

import click

from tms_cli import mesh
from tms_cli.drill.plan import Trial
from tms_cli.drill.report import line
from tms_cli.drill.stand_ins import NICE, StandIns
from tms_cli.drill.trials import LEAD, Hand, Struck
from tms_cli.drill.verdict import Row, empty
from tms_cli.reasons import StandInsEnded
from tms_config.clock import unix_time
from tms_config.config import Site
from tms_reason.errors import TmsError
from tms_ros.node import Ros
from tms_runtime.priority import come_first, others, session_first

T = TypeVar("T")


class Waves:
    """Makes the trials of a plan and keeps their rows."""

    def __init__(self, node: Ros, site: Site, stand_ins: StandIns) -> None:
        self._site, self._stand_ins = site, stand_ins
        self._hands = {machine: Hand(node, site, machine, stand_ins.operasim) for machine in site.file.machines}
        # Raise ROS's threads, but not those that start processes: late samples of the true motion may be lost.
        come_first(NICE, others())
        session_first(os.getpid(), NICE)
        # Twice as many threads as machines, since each trial has a second thread for its strike.
        self._pool = ThreadPoolExecutor(2 * len(self._hands) + 1, "drill")
        self._total = self._made = 0
        self.rows: list[Row] = []

    def warm_up(self) -> None:
        """Move each machine once, so that all subtasks run before the first trial.

        Raises:
            TmsError: a machine does not move.
        """
        list(self._pool.map(Hand.begin, self._hands.values()))
        list(self._pool.map(lambda hand: hand.work.end(), self._hands.values()))

    def go(self, plan: Sequence[list[Trial]]) -> list[Row]:
        """Make the trials, however slow the PC is. Trials that prove nothing are repeated last.

        Raises:
            TmsError: a stand-in has ended, so that there is no machine any more.
        """
        todo, again = list(plan), len(plan)
        self._total = sum(map(len, plan))
        while todo:
            try:
                mesh.wait_ready(self._site, lambda _: None)
            except TmsError as error:
                click.echo(f"the mesh does not come back, the rest is left out: {error}", err=True)
                break
            missed = self._wave(todo.pop(0))
            if missed:
                todo.append(missed)
                again -= 1
            if not again:
                click.echo("too many trials prove nothing, the rest is left out: is this PC busy?", err=True)
                break
            if dead := self._stand_ins.dead():
                raise TmsError(StandInsEnded(tuple(dead), f"{self._site.state}/log"))
        left = [trial for wave in todo for trial in wave]
        proved_nothing = [(row.machine, row.stop, row.fault) for row in self.rows if row.void]
        untried = [trial for trial in left if (trial.machine, trial.stop.name, trial.fault) not in proved_nothing]
        return [*self.rows, *(self._empty(trial) for trial in untried)]

    def _wave(self, wave: list[Trial]) -> list[Trial]:
        """Make one wave; returns the trials to repeat, which proved nothing or failed."""
        if all(trial.stop.own for trial in wave):
            return self._note(wave, self._each(wave, self._alone))
        began = self._each(wave, self._begin)
        ready = [trial for trial, at in zip(wave, began, strict=True) if at is not None]
        shared = any(trial.stop.shared for trial in ready)
        made = dict(zip(ready, self._shared(ready) if shared else self._each(ready, self._single), strict=True))
        self._each([trial for trial in wave if trial not in ready], self._end)
        return self._note(wave, [made.get(trial) for trial in wave])

    def _begin(self, trial: Trial) -> float:
        return self._hands[trial.machine].begin()

    def _alone(self, trial: Trial) -> Row:
        """Make a trial that concerns no other machine, as soon as its own moves."""
        try:
            self._begin(trial)
        except (TmsError, TimeoutError):
            self._end(trial)
            raise
        return self._single(trial)

    def _note(self, wave: list[Trial], rows: Sequence[Row | None]) -> list[Trial]:
        missed = []
        for trial, row in zip(wave, rows, strict=True):
            if row is None or row.void:
                missed.append(trial)
            if row is not None:
                self.rows.append(row)
                self._made += not row.void
                click.echo(f"{self._made}/{self._total} {line(row)}", err=True)
        return missed

    def _single(self, trial: Trial) -> Row:
        hand, struck = self._hands[trial.machine], Struck()
        at = hand.moment(trial)
        self._pool.submit(hand.strike, trial.stop, at, [hand], struck)
        return self._watch(trial, at, struck)

    def _shared(self, wave: list[Trial]) -> list[Row | None]:
        """Make one hit of all machines, at the moment of the first trial."""
        hands, struck = [self._hands[trial.machine] for trial in wave], Struck()
        at = unix_time() + LEAD + wave[0].delay
        self._pool.submit(hands[0].strike, wave[0].stop, at, hands, struck)
        return self._each(wave, lambda trial: self._watch(trial, at, struck))

    def _watch(self, trial: Trial, at: float, struck: Struck) -> Row:
        """Watch one trial and end its run as soon as it is over, since the slowest trials determine a wave's length."""
        try:
            return self._hands[trial.machine].watch(trial, at, struck)
        finally:
            self._end(trial)

    def _end(self, trial: Trial) -> None:
        """End the run of a trial; a failure is printed, and the next wave will find the run."""
        try:
            self._hands[trial.machine].work.end()
        except TmsError as error:
            click.echo(f"{trial.machine}, {trial.stop.name}: {error}", err=True)

    def _each(self, wave: Sequence[Trial], step: Callable[[Trial], T]) -> list[T | None]:
        """Do a step for all trials at the same time; None where it failed, which is printed."""

        def tried(trial: Trial) -> T | None:
            try:
                return step(trial)
            except (TmsError, TimeoutError) as error:
                click.echo(f"{trial.machine}, {trial.stop.name}: {error or 'took too long'}", err=True)
                return None

        return list(self._pool.map(tried, wave))

    def _empty(self, trial: Trial) -> Row:
        return empty(trial, self._site.file.machines[trial.machine].model)

    def close(self) -> None:
        """Free the threads; after an interrupt they end by themselves, once the mesh is down."""
        self._pool.shutdown(wait=False, cancel_futures=True)
