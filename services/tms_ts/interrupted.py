"""Runs that a lost scheduler left open: closed as `interrupted` by its successor, then resumed or abandoned."""

import threading
from collections import deque

from builtin_interfaces.msg import Time
from tms_msg_db.msg import Event, Run
from tms_msg_rc.msg import StopReceipt
from tms_msg_ts.srv import CancelRun, ResumePlan

from tms_config.clock import monotonic
from tms_decision.leaf.events import Key
from tms_decision.past import CLOSE_LIMIT, Stop, all_told, stops_of, what_was_seen
from tms_machine import stamps
from tms_machine.values import to_parameters
from tms_reason import wire
from tms_reason.errors import TaskError
from tms_reason.reason import Reason
from tms_reason.wire import to_line
from tms_runtime.app import App
from tms_ts.interrupted_run import Header, InterruptedRun, Over
from tms_ts.journal import Journal
from tms_ts.machine_stops import reported_by
from tms_ts.place_requests import PlaceRequests
from tms_ts.reasons import (
    GivenUp,
    NotInterrupted,
    StateAbandoned,
    StateBecause,
    StateInterrupted,
)
from tms_ts.run import ALARMS
from tms_ts.run_checkpoint import Records
from tms_ts.run_states import entered

RECEIPT_CHECK_PERIOD = 0.05  # s
RECEIPTS = 1000  # every gateway keeps its last 20 for late comers


class Interrupted:
    """Closes the runs that the checkpoints of this PC show as open, except those that are active again."""

    def __init__(self, app: App, journal: Journal, records: Records, places: PlaceRequests) -> None:
        self._app, self._journal, self._records, self._places = app, journal, records, places
        self._active: set[str] = set()
        self._receipts: deque[Stop] = deque(maxlen=RECEIPTS)
        self._lock = threading.Lock()  # guards the receipts; the executor thread takes it: held for moments only
        self._choosing = threading.Lock()  # a run is resumed or abandoned, and only once
        threading.Thread(target=self._close_all, name="interrupted", daemon=True).start()

    # closing

    def receipt(self, receipt: StopReceipt) -> None:
        """Receive the receipt of a stop that belongs to no active run."""
        at, what = stamps.seconds(receipt.stamp), reported_by(receipt)
        with self._lock:
            self._receipts.append(Stop(receipt.machine, receipt.run, at, receipt.confirmed, receipt.latched, what))

    def _close_all(self) -> None:
        left = [past for past in self._records.past() if not past.closed]
        for past in left:
            if past.header is not None and past.over is not None:
                self._complete(past, past.header, past.over)
        left = [past for past in left if past.over is None]
        deadline = monotonic() + CLOSE_LIMIT
        while not all(map(self._all_reported, left)) and monotonic() < deadline:
            if self._app.stopping.wait(RECEIPT_CHECK_PERIOD):
                return
        for past in left:
            if past.header is not None and past.header.run_id not in self._active:
                self._close(past, past.header)

    def _all_reported(self, past: InterruptedRun) -> bool:
        header = past.header
        return header is None or all_told(past.lost(header), self._stops(past, header))

    def _stops(self, past: InterruptedRun, header: Header) -> list[Stop]:
        """The stops at the end of this run."""
        with self._lock:
            return stops_of(past.lost(header), self._receipts)

    def _close(self, past: InterruptedRun, header: Header) -> None:
        record, number, stops = self._records.open(header.run_id), past.last_event, self._stops(past, header)
        reason, unseen = what_was_seen(past.lost(header), stops)
        reported = [("stop", one.what) for one in stops] + [("alarm", alarm) for alarm in unseen]
        ALARMS.inc(len(unseen))
        for kind, what in [*reported, ("run", StateBecause(StateInterrupted(), reason))]:
            number += 1
            record.event(number)
            stamp = self._app.ros.now()
            self._journal.put(Event(run_id=header.run_id, number=number, stamp=stamp, kind=kind, text=to_line(what)))
        self._journal.put(_row(header, "interrupted", reason, self._app.ros.now()))
        record.interrupted()
        record.close()
        self._app.log.warning("interrupted", run=header.run_id)

    def _complete(self, past: InterruptedRun, header: Header, over: Over) -> None:
        """Report the end of a run that had ended before the power went: that report may be lost, or comes twice."""
        stamp = stamps.time(past.last_time)
        why = wire.of(over.reason)
        text = to_line(entered(over.outcome, why))
        self._journal.put(Event(run_id=header.run_id, number=over.event, stamp=stamp, kind="run", text=text))
        self._journal.put(_row(header, over.outcome, why, stamp))
        self._records.open(header.run_id).remove()
        self._places.free_all(header.run_id, header.machines)

    # what a person does about it

    def begin(self, run_id: str) -> tuple[InterruptedRun, Header]:
        """The run that is to be resumed now.

        Raises:
            TaskError: NotInterrupted.
        """
        with self._choosing:
            past, header = self._find(run_id)
            self._active.add(header.run_id)
        return past, header

    def over(self, run_id: str) -> None:
        """Note that a resumed run has ended, successfully or not."""
        self._active.discard(run_id)

    def plan(self, request: ResumePlan.Request, response: ResumePlan.Response) -> ResumePlan.Response:
        """Answer with the goals that a resumed run would do first."""
        try:
            past, header = self._find(request.run_id)
        except TaskError as error:
            response.error_code, response.error_msg = error.code, to_line(error.reason)
            return response
        response.task_id = header.task_id
        response.done = [_words(key) + ("" if succeeded else " (failed)") for key, succeeded in past.ended]
        response.next = [_words(key) for key in past.open]
        return response

    def abandon(self, request: CancelRun.Request, response: CancelRun.Response) -> CancelRun.Response:
        """Abandon an interrupted run: it can no longer be resumed."""
        try:
            with self._choosing:
                self._give_up(*self._find(request.run_id))
        except TaskError as error:
            response.error_code, response.error_msg = error.code, to_line(error.reason)
        return response

    def _give_up(self, past: InterruptedRun, header: Header) -> None:
        stamp = self._app.ros.now()
        text = to_line(StateAbandoned())
        event = Event(run_id=header.run_id, number=past.last_event + 1, stamp=stamp, kind="run", text=text)
        self._journal.put(event)
        self._journal.put(_row(header, "abandoned", GivenUp(), stamp))
        self._records.open(header.run_id).remove()

    def _find(self, run_id: str) -> tuple[InterruptedRun, Header]:
        past = self._records.find(run_id)
        if past is None or past.header is None or not past.closed or past.header.run_id in self._active:
            known = tuple(p.header.run_id for p in self._records.past() if p.header and p.closed)
            raise TaskError(NotInterrupted(run_id, known), "NO_RUN")
        return past, past.header


def _words(key: Key) -> str:
    node, machine, subtask, record = key
    return f"{node}: /{machine}/{subtask}, record {record}"


def _row(header: Header, state: str, reason: Reason | None, ended: Time) -> Run:
    return Run(
        run_id=header.run_id, task_id=header.task_id, description=header.description, state=state,
        reason=to_line(reason), machines=header.machines, records=header.records, ended_at=ended,
        started_at=Time(sec=header.started[0], nanosec=header.started[1]), values=to_parameters(header.values),
    )  # fmt: skip
