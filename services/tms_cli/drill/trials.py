"""One trial: a moving machine is hit at a moment, with a fault, and recorded until the outcome is certain."""

import csv
import math
from concurrent.futures import Future
from dataclasses import dataclass, field
from datetime import datetime, timezone

import psutil
from tms_msg_rc.srv import StopMachine

from tms_cli.drill.busy import stood_still
from tms_cli.drill.history import FOLDER, Hit, happenings, keep
from tms_cli.drill.hits import BACK_LIMIT, Hits, power_off
from tms_cli.drill.operasim import OperaSim
from tms_cli.drill.plan import NONE, SUBTASK, TROUBLES, TS, How, StopScenario, Trial
from tms_cli.drill.record import TrialRecording
from tms_cli.drill.stop_observer import StopObserver
from tms_cli.drill.verdict import (
    AFTER,
    BY_ITSELF,
    GOES_ON,
    HUNG,
    UNPROVEN,
    UNTOLD,
    Row,
    TrialFacts,
    judge,
    takes_gateway,
)
from tms_cli.drill.work import Work
from tms_cli.reasons import DoesNotMove, NobodySays
from tms_config.clock import sleep, unix_time
from tms_config.config import Site
from tms_decision.reasons import SoftwareStop
from tms_machine.facts import facts_of
from tms_proof.standstill import StandStill
from tms_reason import wire
from tms_reason.errors import TmsError
from tms_reason.wire import to_line
from tms_ros.node import Ros

MOVES_LIMIT = 40.0  # s for a run to move its machine
LEAD = 0.8  # s from the choice of the moment to the hit, since a fault may begin before the hit
FRESH = 2.0  # s after the begin of a motion in which it surely lasts long enough for a hit
BESIDE = 1.0  # s for which a motion must go on after the loss of a bystander
RECEIPT_LIMIT = 25.0  # s
RUN_LIMIT = 40.0  # s from the hit for the run to go on, end, or be interrupted
LATCH_LIMIT = 5.0  # s for a latch to be published after all processes work again
CREEP_STARTS = 3.0  # s of stand-still after which the fault `creep` moves
CHECK_PERIOD = 0.5  # s
PRESSED = 1.0  # s for a stop by hand to begin
LEAVE = ("creep", "drift")  # faults that move a standing machine
CAUSE = to_line(SoftwareStop())


@dataclass
class Struck:
    """A hit, for which the trials of several machines may wait."""

    hit: "Future[float]" = field(default_factory=Future)  # s since 1970
    back: "Future[float | None]" = field(default_factory=Future)  # s from the hit
    processes: tuple[str, ...] = ()  # that are hit
    started: dict[str, float] = field(default_factory=dict)  # when those that were killed were seen again, s since 1970


class Hand:
    """Runs the trials of one machine."""

    def __init__(self, node: Ros, site: Site, machine: str, operasim: OperaSim | None) -> None:
        self._site, self.machine, self._operasim = site, machine, operasim
        self.model = site.file.machines[machine].model
        self.eyes, self.work, self._node = StopObserver(node, site, machine, operasim), Work(node, site, machine), node
        watch = StandStill(facts_of(site, machine))
        self._ends = watch.dead_time + watch.braking
        self._hits = Hits(site)
        self._folder = site.state / "truth"
        self._folder.mkdir(mode=0o700, exist_ok=True)
        node.prepare(StopMachine, f"/{machine}/rc/stop")

    def begin(self) -> float:
        """Have the machine moved; returns the begin of its goal.

        Raises:
            TmsError: it does not move, even after a stop and a re-arm by hand.
        """
        for last in (False, True):
            self.eyes.forget_open_goals()
            self.work.begin()
            begun = unix_time()
            self.eyes.wait(lambda _: self.eyes.open_since() is not None or self.work.ended(), begun, MOVES_LIMIT)
            began = self.eyes.open_since()
            if began is not None:
                return began
            if last:
                break
            self.work.end()
            self._press()
            sleep(PRESSED)
        raise TmsError(DoesNotMove(wire.of(self.work.reason()) or NobodySays()))

    def moment(self, trial: Trial) -> float:
        """The moment of the hit: the trial's delay after the begin of a motion."""
        deadline = unix_time() + MOVES_LIMIT
        while unix_time() < deadline:
            began = self.eyes.open_since()
            if began is not None and unix_time() - began < FRESH:
                break
            sleep(CHECK_PERIOD / 10)
        return max(unix_time(), (began or 0.0) + trial.delay)

    def strike(self, stop: StopScenario, at: float, hands: "list[Hand]", struck: Struck) -> None:
        """Hit these machines at a moment, and set when the lost processes work again. Runs in a thread of its own."""
        try:
            self._strike(stop, at, hands, struck)
        except (TmsError, OSError, psutil.Error) as error:  # the waiting trials must get the error
            for future in (struck.hit, struck.back):
                if not future.done():
                    future.set_exception(error)

    def _strike(self, stop: StopScenario, at: float, hands: "list[Hand]", struck: Struck) -> None:
        if stop.how in (How.CANCEL, How.SOFTWARE):
            until(at)
            struck.hit.set_result(unix_time())
            self.work.cancel() if stop.how is How.CANCEL else self._press()
            struck.back.set_result(0.0)
        elif self._operasim is not None and stop.how in TROUBLES:
            until(at)
            struck.hit.set_result(unix_time())
            struck.back.set_result(self._operasim.trouble(stop.how))
        elif stop.how is How.POWER:
            pids = self._hits.everything()
            struck.processes = self._hits.all_names([hand.work.subtask for hand in hands])
            until(at)
            struck.hit.set_result(power_off(pids))
            struck.back.set_result(self._hits.power_on(pids, struck.hit.result(), struck.started))
        else:
            found = self._hits.pids(self._hits.names(stop, {hand.machine: hand.work.subtask for hand in hands}))
            struck.processes = tuple(found)
            until(at)
            struck.hit.set_result(self._hits.hit(stop.how, list(found.values())))
            struck.back.set_result(self._hits.back(stop.how, found, struck.hit.result(), struck.started))

    def _press(self) -> None:
        self._node.call_unanswered(StopMachine, f"/{self.machine}/rc/stop", StopMachine.Request(cause=CAUSE))

    def watch(self, trial: Trial, at: float, struck: Struck) -> Row:
        """Record a trial that is hit at a moment; returns the verdict."""
        stop, begun = trial.stop, at
        if trial.fault != NONE:
            until(at + trial.fault_at)
            begun = unix_time()
            self.work.be(trial.fault)
        hit = struck.hit.result(MOVES_LIMIT)
        begun, stopped = min(begun, hit), hit
        if stop.how is How.POWER or (stop.how is How.KILL and TS in stop.processes):
            self.work.scheduler_lost()
        if not stop.moves:
            until(hit + BESIDE)
            stopped = unix_time()
            self.work.cancel()
        self.eyes.wait(lambda record: self._over(record, stopped), begun, RECEIPT_LIMIT)
        self._look_on(trial, begun)
        outcome = self._outcome(trial, begun, stopped)
        back = struck.back.result(2 * BACK_LIMIT)
        watched = hit + back if takes_gateway(trial) and back is not None else 0.0
        self._look_on(trial, begun, watched)  # another stop may have ended meanwhile
        record = self._last_words(trial, begun)
        self._note_history(trial, struck)
        stops = [one.begun for one in record.receipts]
        busy = "" if stop.moves else stood_still(self._site, self.machine, stops)
        elsewhere = self._elsewhere(trial, struck)
        row = judge(TrialFacts(
            trial, self.model, record, begun, hit, stopped, self._ends, back, outcome, busy, elsewhere
        ))  # fmt: skip
        if row.false_receipt or (row.unconfirmed and row.in_order) or row.ran_on:
            self._keep(record, hit)
        return row

    def _elsewhere(self, trial: Trial, struck: Struck) -> str:
        """The subtask behind the motion at the hit, where that was not hit, since the feedback with it came late."""
        if trial.stop.processes != (SUBTASK,):
            return ""
        behind = self.work.behind(struck.hit.result())
        return "" if behind in struck.processes else behind

    def _note_history(self, trial: Trial, struck: Struck) -> None:
        """Keep what happened since the begin of the run; without the run's own history it says nothing."""
        hit, back = struck.hit.result(), struck.back.result()
        run = self.work.history()
        if run and back is not None:
            what = Hit(hit, struck.processes, struck.started, hit + back)
            found = happenings(trial, self.eyes.since(run[0][0]), what, run)
            keep(self._site.state / FOLDER, trial, self.work.subtask, found)

    def _keep(self, record: TrialRecording, hit: float) -> None:
        """Keep the true motion of a conspicuous trial as a file."""
        path = self._folder / f"{self.machine}-{datetime.fromtimestamp(hit, timezone.utc):%H%M%S.%f}.csv"
        with path.open("w", newline="", encoding="utf-8") as file:
            table = csv.writer(file)
            table.writerow(["s from the hit", "share of the limit of standing", *record.truth[0].joints, "x", "y"])
            for one in record.truth:
                numbers = [one.at - hit, one.share, *one.joints.values(), *one.place]
                table.writerow([f"{number:.4f}" for number in numbers])

    def _over(self, record: TrialRecording, stopped: float) -> bool:
        """Whether there is a receipt, or the motion ended by itself before a stop was possible."""
        over = stopped + BY_ITSELF
        begun_by_then = [goal for goal in record.goals.values() if goal.began <= over]
        arrived = all(goal.arrived and (goal.ended or 0.0) < over for goal in begun_by_then)
        return bool(record.receipts) or (arrived and unix_time() > over)

    def _look_on(self, trial: Trial, begun: float, watched: float = 0.0) -> None:
        """Record for as long as a receipt claims a stand-still; where a fault ends it, until that is reported.

        `watched`: when a gateway is there to report it, s since 1970.
        """
        creeps = trial.fault in LEAVE
        longer = CREEP_STARTS + UNPROVEN if creeps else 0.0

        def enough(record: TrialRecording) -> bool:
            if creeps and not all(one.confirmed for one in record.receipts):
                return True
            at = max((one.at for one in record.receipts if one.confirmed), default=0.0)
            at = max(at, watched) if creeps else at
            end = record.truth[-1].at if record.truth else 0.0
            return record.goal_after(at) < at + AFTER + longer or end > at + AFTER + longer

        self.eyes.wait(enough, begun, 2 * AFTER + longer)

    def _outcome(self, trial: Trial, begun: float, stopped: float) -> str:
        """Wait for the run's outcome: it goes on, has ended, or waits to be resumed."""
        deadline = stopped + RUN_LIMIT
        while unix_time() < deadline:
            if (ended := self.work.outcome()) is not None:
                return ended
            record = self.eyes.since(begun)
            proven = max((one.at for one in record.receipts), default=stopped)
            if trial.stop.moves and not self.work.lost and record.goal_after(proven) < math.inf:
                return GOES_ON
            sleep(CHECK_PERIOD)
        return UNTOLD if self.work.untold else HUNG

    def _last_words(self, trial: Trial, begun: float) -> TrialRecording:
        """The record at the end: a restarted gateway publishes its latch a moment later."""

        def reported(record: TrialRecording) -> bool:
            wanted = trial.stop.latches or not all(one.confirmed for one in record.receipts)
            return not wanted or (bool(record.states) and bool(record.states[-1].latch))

        self.eyes.wait(reported, begun, LATCH_LIMIT)
        return self.eyes.since(begun)


def until(at: float) -> None:
    """Sleep until a moment (s since 1970)."""
    sleep(max(0.0, at - unix_time()))
