"""Leaves that are behaviours of py_trees: a behaviour that was written for py_trees becomes a node of the palette.

A node class of this kind declares its ports and makes the behaviour from them, anew at each start. py_trees' own `tick`
drives it, so `setup`, `initialise`, `update`, `terminate` and `shutdown` are called as py_trees documents them, all on
the thread of the run and never two at a time. It may be a whole tree of py_trees, too: to the outside it is one leaf.

Rules for a behaviour with threads or processes of its own:
- Each is kept in an attribute of the behaviour, where this leaf finds it.
- `initialise` starts them and `update` reads their results; both return at once.
- `terminate` asks them to end and returns at once, too: the halt of a machine must not be delayed. This leaf does not
  start again before they have ended, and `Tree.workers` lists those that have not ended yet.
- The blackboard of py_trees is refused: all runs of the process would share it. Values come and go through ports.
"""

from __future__ import annotations

from multiprocessing.process import BaseProcess
from threading import Thread
from typing import ClassVar

import structlog
from py_trees.behaviour import Behaviour
from py_trees.common import Status as PyTreesStatus

from tms_reason.reason import Foreign
from tms_ts.bt.errors import TickError
from tms_ts.bt.leaf import StatefulAction
from tms_ts.bt.node import AtOnce
from tms_ts.bt.status import FROM_PY_TREES, RUNNING, Status
from tms_ts.tree_reasons import PyTreesBlackboard, UsePorts, WaitsForWorkers

Worker = Thread | BaseProcess

log = structlog.stdlib.get_logger(__name__)


class PyTreesLeaf(StatefulAction):
    """A leaf that is a behaviour of py_trees from its start to its end."""

    __slots__ = ("_live", "_reported")
    reports: ClassVar[bool] = True  # `feedback_message` of the behaviour is why it is RUNNING or has failed

    def prepare(self) -> None:
        """Begin without a behaviour."""
        self._live: Behaviour | None = None
        self._reported: list[Worker] = []  # to end

    def behaviour(self) -> Behaviour:
        """For node authors: make the behaviour from the present values of the ports."""
        raise NotImplementedError

    def ended(self, behaviour: Behaviour) -> None:
        """For node authors: write outputs when the behaviour has completed."""

    def workers(self) -> list[Worker]:
        """Threads and processes of earlier starts that were asked to end and have not ended yet."""
        self._reported = [worker for worker in self._reported if worker.is_alive()]
        return self._reported

    def on_start(self) -> Status:
        """Make the behaviour, unless threads or processes of the last start still run."""
        return RUNNING if self._waits() else self._begin()

    def on_running(self) -> Status:
        """Tick the behaviour, on the thread of the run."""
        if self._live is not None:
            return self._tick(self._live)
        return RUNNING if self._waits() else self._begin()

    def halt(self) -> None:
        """Stop the behaviour, also one that an exception has left behind."""
        live, self._live = self._live, None
        if live is not None:
            self._drop(live, stop=True)

    def synchronous_outcomes(self, children: list[AtOnce]) -> AtOnce:
        """Both: what a behaviour of py_trees may do is unknown."""
        return True, True

    def _waits(self) -> bool:
        if not self.workers():
            return False
        self.reason = WaitsForWorkers()
        return True

    def _begin(self) -> Status:
        made = self.behaviour()
        for one in made.iterate():
            one.logger = log.bind(node=self.path)  # type: ignore[assignment]  # py_trees' own one prints
            if one.blackboards:
                raise TickError(PyTreesBlackboard(self.registration_name), hint=UsePorts())
        self._live = made
        made.setup_with_descendants()
        return self._tick(made)

    def _tick(self, live: Behaviour) -> Status:
        live.tick_once()
        status = FROM_PY_TREES[live.status]
        if self.reports:
            self.reason = Foreign(live.feedback_message) if live.feedback_message else None
        if status.completed:
            self.ended(live)
            self._live = None
            self._drop(live, stop=False)
        return status

    def _drop(self, live: Behaviour, *, stop: bool) -> None:
        self._reported += [
            worker for one in live.iterate() for worker in vars(one).values() if isinstance(worker, Worker)
        ]
        try:
            if stop:
                live.stop(PyTreesStatus.INVALID)
        finally:
            for one in live.iterate():
                one.shutdown()
