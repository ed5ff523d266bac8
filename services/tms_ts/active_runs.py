"""The runs that are active now, and which machine belongs to which of them. Pure."""

import threading
from collections.abc import Iterator

from tms_places.waits import Order
from tms_reason.errors import TaskError
from tms_ts.other_runs import orders_in, writes_in
from tms_ts.reasons import MachineBusy
from tms_ts.run import Run


class ActiveRuns:
    """All active runs; one machine is in one run at a time. Any thread may call."""

    def __init__(self) -> None:
        self._runs: dict[str, Run] = {}
        self._holders: dict[str, str] = {}  # machine -> run that moves it
        self._lock = threading.Lock()  # guards the two above; held for moments only

    def __iter__(self) -> Iterator[Run]:
        with self._lock:
            return iter(list(self._runs.values()))

    def find(self, run_id: str) -> Run | None:
        """The run of this name."""
        with self._lock:
            return self._runs.get(run_id)

    def names(self) -> tuple[str, ...]:
        """The names of all active runs."""
        with self._lock:
            return tuple(self._runs)

    def add(self, run: Run) -> None:
        """Add a run that begins; it holds no machine yet."""
        with self._lock:
            self._runs[run.facts.run_id] = run

    def remove(self, run: Run) -> None:
        """Remove a run that has ended: its machines are free."""
        run_id = run.facts.run_id
        with self._lock:
            del self._runs[run_id]
            for machine in [name for name, holder in self._holders.items() if holder == run_id]:
                del self._holders[machine]

    def hold(self, run: Run) -> None:
        """Give a run its machines, for it alone.

        Raises:
            TaskError: MachineBusy, another run holds one of them.
        """
        with self._lock:
            for machine in run.facts.machines:
                holder = self._holders.get(machine)
                if holder is not None:
                    raise TaskError(MachineBusy(machine, holder))
            self._holders.update(dict.fromkeys(run.facts.machines, run.facts.run_id))

    def holder(self, machine: str) -> str | None:
        """The run that holds a machine."""
        with self._lock:
            return self._holders.get(machine)

    def held_by(self, run: Run) -> list[str]:
        """The machines that a run holds."""
        with self._lock:
            return [machine for machine, holder in self._holders.items() if holder == run.facts.run_id]

    def orders(self) -> dict[str, set[Order]]:
        """Which places the machines of active runs hold while they take others."""
        return orders_in(run.facts for run in self)

    def writes(self, record: str, field: str) -> bool:
        """Whether an active run writes a shared value."""
        return writes_in((run.facts for run in self), record, field)
