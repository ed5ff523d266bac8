"""Which run has which machine, where a site has several schedulers. Pure.

A lease is an order among schedulers, and no permit: what protects a machine is its gateway, which obeys the run with
the largest number only. So a run goes on while nobody can renew its leases, and nobody else gets its machines then.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

from tms_reason.errors import TaskError
from tms_schedulers.reasons import MachineLeased, RunOutdated

LEASE = 10.0  # s


@dataclass(frozen=True)
class Lease:
    """The last run that had a machine; `over`: it gave it back."""

    scheduler: str
    run_id: str
    number: int
    over: bool = False


class LeaseBook:
    """All leases of a site; times are monotonic [s]."""

    def __init__(self, leases: Mapping[str, Lease], now: float) -> None:
        """`leases`: by machine, as they were kept; each counts anew, since nobody knows how long it was not renewed."""
        self.leases = dict(leases)
        self._renewed = dict.fromkeys(leases, now)

    @property
    def last(self) -> int:
        """The largest number of a run."""
        return max((one.number for one in self.leases.values()), default=0)

    def wanted(self, lease: Lease, machines: Iterable[str], now: float) -> dict[str, Lease]:
        """What changes when a run gets all its machines, or keeps them: `put` it once it is stored.

        Which of its own runs has a machine, a scheduler knows itself: only leases of others refuse.

        Raises:
            TaskError: MachineLeased, another scheduler has one of them; RunOutdated, one had a newer run since.
        """
        for machine in machines:
            self._refuse(lease, machine, now)
        return {machine: lease for machine in machines if self.leases.get(machine) != lease}

    def given_back(self, lease: Lease, machines: Iterable[str]) -> dict[str, Lease]:
        """What changes when a run ends: not what is another's by now."""
        return {machine: replace(lease, over=True) for machine in machines if self.leases.get(machine) == lease}

    def put(self, changed: Mapping[str, Lease], machines: Iterable[str], now: float) -> None:
        """Take a change, and note that these machines were asked for."""
        self.leases.update(changed)
        self._renewed.update(dict.fromkeys(machines, now))

    def _refuse(self, lease: Lease, machine: str, now: float) -> None:
        there = self.leases.get(machine)
        if there is None or there == lease:
            return
        if not there.over and now - self._renewed[machine] < LEASE and there.scheduler != lease.scheduler:
            raise TaskError(MachineLeased(machine, there.run_id, there.scheduler))
        if lease.number <= there.number:
            raise TaskError(RunOutdated(machine, there.run_id))
