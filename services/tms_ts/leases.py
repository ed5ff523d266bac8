"""What this scheduler shares with others of the site: whose task it is, and which machines its runs have.

Nothing here is asked where a site has one scheduler. A run goes on while its leases cannot be renewed: nobody else gets
its machines then, and their gateways obey the newest run only.
"""

from collections import deque
from collections.abc import Iterable

from tms_msg_db.srv import LeaseMachines
from tms_msg_ts.srv import CancelRun

from tms_config.clock import monotonic
from tms_machine.asking import ask
from tms_reason.errors import RosError, TaskError
from tms_runtime.app import App
from tms_schedulers.lease_book import LEASE
from tms_schedulers.names import own, responsible, schedulers
from tms_schedulers.reasons import MachineLeased, OtherScheduler, RunOutdated
from tms_ts.active_runs import ActiveRuns
from tms_ts.facts import Facts
from tms_ts.run import Run

SERVICE = "/tms/db/lease_machines"
LIMIT = 5.0  # s
LOOK = 0.2  # s between looks whether something is to be given back
RENEW = LEASE / 4  # s
WAITING = 1000  # ended runs whose machines are to be given back; a lease is over by itself, too


class Leases:
    """The leases of this scheduler's runs; any thread may call."""

    def __init__(self, app: App, runs: ActiveRuns) -> None:
        self._app, self._runs = app, runs
        self.scheduler = own(app.site, app.process.full)
        self.several = len(schedulers(app.site)) > 1  # of the site
        self._ended: deque[tuple[LeaseMachines.Request, float]] = deque(maxlen=WAITING)
        self._renewed = monotonic()
        if self.several:
            app.ros.prepare(LeaseMachines, SERVICE)
            app.ros.poll_in_thread(LOOK, self._look, "leases")

    def refuse_other(self, machines: Iterable[str]) -> None:
        """Refuse a task of another scheduler, while that one is there.

        Raises:
            TaskError: OtherScheduler.
        """
        wanted = sorted(machines)
        whose = responsible(self._app.site, wanted)
        if whose != self.scheduler and self._app.ros.has_service(CancelRun, whose.named("cancel_run")):
            raise TaskError(OtherScheduler(whose.process, tuple(wanted)))

    def last(self) -> int:
        """A number that those of new runs must be above.

        Raises:
            RosError: the database does not answer.
        """
        return int(self._ask(LeaseMachines.Request()).last) if self.several else 0

    def take(self, facts: Facts) -> None:
        """Have the machines of a run for it alone, on the whole site.

        Raises:
            RosError: another scheduler's run has one of them, or the database does not answer.
        """
        if self.several:
            self._ask(self._request(facts, facts.machines))

    def give_back(self, facts: Facts) -> None:
        """A run has ended; returns at once."""
        if self.several and facts.machines:
            request = self._request(facts, facts.machines)
            request.over = True
            self._ended.append((request, monotonic() + LEASE))

    def _request(self, facts: Facts, machines: Iterable[str]) -> LeaseMachines.Request:
        return LeaseMachines.Request(
            scheduler=self.scheduler.process, run_id=facts.run_id, number=facts.number, machines=list(machines)
        )

    def _ask(self, request: LeaseMachines.Request) -> LeaseMachines.Response:
        return ask(self._app.ros, LeaseMachines, SERVICE, request, LIMIT)

    def _look(self) -> None:
        while self._ended:
            request, until = self._ended[0]
            if not self._told(request) and monotonic() < until:
                return
            self._ended.popleft()
        if monotonic() - self._renewed >= RENEW:
            self._renewed = monotonic()
            for run in self._runs:
                self._renew(run)

    def _told(self, request: LeaseMachines.Request) -> bool:
        try:
            self._ask(request)
        except RosError:
            return False
        return True

    def _renew(self, run: Run) -> None:
        try:
            self._ask(self._request(run.facts, self._runs.held_by(run)))
        except RosError as error:
            if error.code in (MachineLeased.code, RunOutdated.code):
                run.cancel("cancelled", error.reason)
