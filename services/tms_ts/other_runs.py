"""What runs of the site's other schedulers hold and write, for the checks before a run of this one."""

import threading
from collections.abc import Iterable, Mapping

from tms_msg_ts.msg import PlaceOrder, RunState, RunStates, SharedValue

from tms_places.waits import Order
from tms_runtime.app import App
from tms_schedulers.hearing import sample_runs
from tms_schedulers.names import Scheduler, schedulers
from tms_ts.facts import Facts


class OtherRuns:
    """The active runs of the other schedulers, as they told them last: once a second. Any thread may call."""

    def __init__(self, app: App, own: Scheduler) -> None:
        several = len(schedulers(app.site)) > 1
        self._own, self._take = own, sample_runs(app.ros, app.site) if several else None
        self._told, self._taking = RunStates(), threading.Lock()

    def orders(self) -> dict[str, set[Order]]:
        """Which places their machines hold while they take others."""
        return orders_in(self._runs())

    def writes(self, record: str, field: str) -> bool:
        """Whether one of them writes a shared value."""
        return writes_in(self._runs(), record, field)

    def _runs(self) -> list[RunState]:
        if self._take is None:
            return []
        with self._taking:
            self._told = self._take() or self._told
        return [run for run in self._told.runs if not self._own.owns(run.run_id)]


def orders_in(runs: Iterable[Facts | RunState]) -> dict[str, set[Order]]:
    """Which places machines of runs hold while they take others."""
    found: dict[str, set[Order]] = {}
    for run in runs:
        for one in run.orders:
            found.setdefault(one.machine, set()).add((one.held, one.taken))
    return found


def writes_in(runs: Iterable[Facts | RunState], record: str, field: str) -> bool:
    """Whether one of the runs writes a shared value."""
    return any((one.record, one.field) == (record, field) for run in runs for one in run.writes)


def orders_told(orders: Mapping[str, Iterable[Order]]) -> list[PlaceOrder]:
    """For the other schedulers: of the machines of a run."""
    return [
        PlaceOrder(machine=machine, held=held, taken=taken)
        for machine, some in orders.items()
        for held, taken in sorted(some)
    ]


def writes_told(writes: Iterable[tuple[str, str]]) -> list[SharedValue]:
    """For the other schedulers: what a run writes."""
    return [SharedValue(record=record, field=field) for record, field in sorted(set(writes))]
