"""Process of one subtask: the action server for its leaf goals around one file of tms_subtasks/."""

import threading
from collections.abc import Awaitable, Callable, Mapping
from typing import Any

from pydantic import ValidationError
from tms_msg_db.srv import GetParameter, SetParameter
from tms_msg_ts.action import LeafNodeBase

from tms_config.clock import monotonic
from tms_kit.machine import Machine, SubtaskCancelled
from tms_kit.senders import GONE, Senders
from tms_kit.subtask import Params, Subtask, load
from tms_kit.yard import Yard
from tms_machine.goal_inputs import KINDS, parted
from tms_machine.leaf_forms import own_action
from tms_machine.permit import Permit, watch_server
from tms_machine.reasons import BadRecord, Busy, MotionNotEnded, NoDatabase, WaitingFor
from tms_machine.record_lock import FLAG, RecordLock
from tms_machine.values import Value, from_parameters, to_parameters
from tms_reason.errors import RosError, SubtaskFailed
from tms_reason.reason import Foreign, Reason
from tms_reason.validation import explain
from tms_reason.wire import refusal
from tms_ros.client import AnyPeer
from tms_ros.goals import Ended, Outcome
from tms_ros.reasons import Internal
from tms_ros.server import Goal
from tms_runtime.app import App

DB_LIMIT = 10.0  # s to wait for the database at the start; after that, goals are refused with a reason
RECORD_LIMIT = 0.8  # s for the database while a goal waits for its answer: a C++ leaf gives up after 1 s
DISCOVERY_CHECK_PERIOD = 0.05  # s; forty subtasks of a PC that starts look for the database at the same time
GONE_LIMIT, MOMENT = GONE + 0.5, 0.02  # s that a goal waits for the end of the last one; between looks
FEEDBACK_GAP = 0.1  # s between feedbacks
LeafGoal = Goal[LeafNodeBase.Goal, LeafNodeBase.Feedback]


def start(app: App) -> None:
    """Serve `/<machine>/<action>`."""
    assert app.process.action is not None
    use = app.site.model_of(app.machine).subtask(app.process.action)
    server = _Server(app, load(use.run), dict(use.inputs), use.max_age)
    app.ready_when(lambda: None if server.offered else WaitingFor("tms:db"))
    threading.Thread(target=server.offer, name="offer", daemon=True).start()


class _Server:
    """Serves one goal at a time: a machine does one thing at a time."""

    def __init__(self, app: App, kind: type[Subtask], inputs: dict[str, Any], max_age: float) -> None:
        self._app, self._kind, self._inputs, self._max_age = app, kind, inputs, max_age
        self._permit = Permit(app.ros, app.pulse, app.machine, str(app.process.action))
        self._watches: dict[str, Callable[[AnyPeer], None]] = {}
        self._senders = Senders(app, waits=kind.waits)
        self._yard: Yard | None = None
        self._action = own_action(app.site, app.machine, str(app.process.action))  # its type and its name
        self._reserved = False
        self._want: Params | None = None
        self._lock: RecordLock | None = None
        self._plans = bool(inputs.get("plan_only"))
        self.offered = False

    def offer(self) -> None:
        """Serve once the database answers: the first goal comes as soon as the action is discovered."""
        app, deadline = self._app, monotonic() + DB_LIMIT
        while not app.ros.has_service(GetParameter, "/tms/db/get_parameter") and monotonic() < deadline:
            app.stopping.wait(DISCOVERY_CHECK_PERIOD)
        app.ros.serve(*self._action, self.run, self.accept)
        self.offered = True

    async def accept(self, request: LeafNodeBase.Goal) -> Reason | None:
        deadline = monotonic() + GONE_LIMIT
        while self._reserved and self._senders.gone and monotonic() < deadline:
            await self._moment()  # a run that is resumed may come while the goal of its lost scheduler ends
        if self._reserved:
            return Busy(self._app.process.full)
        self._reserved = True
        wrong = await self._check(request)
        self._reserved = wrong is None
        if wrong is not None:
            self._app.log.warning("rejected", record=request.record_name, reason=wrong)
        return wrong

    def _moment(self) -> Awaitable[None]:
        over: Any = self._app.ros.create_future()
        self._app.ros.after(MOMENT, lambda: over.set_result(None))
        waited: Awaitable[None] = over
        return waited

    async def _check(self, request: LeafNodeBase.Goal) -> Reason | None:
        self._want = self._lock = None
        record, given = parted(request.record_name)
        if (why := self._kind.not_taken(given)) is not None or self._kind.params is None:
            return why
        if set(self._kind.params.model_fields) <= {*self._inputs, *KINDS}:  # no parameter is left for a record
            self._want = self._kind.params.model_validate({**given, **self._inputs})
            return None
        wanted = GetParameter.Request(model_name=request.model_name, record_name=record, max_age=self._max_age)
        answer = await self._app.ros.call_async(GetParameter, "/tms/db/get_parameter", wanted, RECORD_LIMIT)
        if answer is None:
            return NoDatabase("tms:db")
        if answer.error_code:
            return refusal(answer.error_code, answer.error_msg)
        fields = from_parameters(answer.record.values)
        if FLAG in fields and answer.record.type == "dynamic" and "plan_only" in self._inputs:
            self._lock = RecordLock(self._app.ros, self._app.process.full, request.model_name, record)
        try:
            self._want = self._checked(request, fields)
        except SubtaskFailed as error:
            if self._lock is not None and not self._plans:
                self._lock.release()  # the variant that moves always releases it
            return error.reason
        return None

    def _checked(self, request: LeafNodeBase.Goal, fields: dict[str, Value]) -> Params:
        """The parameters of the subtask, from a record's fields.

        Raises:
            SubtaskFailed: BadRecord, with what is wrong.
        """
        assert self._kind.params is not None
        record, given = parted(request.record_name)
        try:
            return self._kind.params.model_validate({**fields, **given, **self._inputs})
        except ValidationError as error:
            name = f"{request.model_name}/{record}"
            raise SubtaskFailed(BadRecord(name, explain(error))) from None

    def run(self, goal: LeafGoal) -> Ended[LeafNodeBase.Result]:
        outcome = Outcome.ABORTED
        self._permit.hold(goal.uuid)
        self._senders.watch(goal)
        try:
            if (why := self._senders.refusal(goal)) is None:
                outcome = self._execute(goal)
            else:
                self._app.log.warning("rejected", goal=goal.id, reason=why)
                _Feedback(goal).last(why)
        finally:
            self._senders.watch(None)
            self._permit.drop()
            self._reserved = False
        result = self._action[0].Result()
        result.result = outcome is Outcome.SUCCEEDED
        return outcome, result

    def _execute(self, goal: LeafGoal) -> Outcome:
        """Run the subtask; when this returns, its motion has ended in any case."""
        request, lock = goal.request, self._lock
        record, _ = parted(request.record_name)
        machine, subtask = self._begin(goal)
        say = _Feedback(goal)
        failure: SubtaskFailed | None = None
        finished = stopped = cancelled = False
        try:
            if lock is not None and self._plans:
                lock.take()
                # Sensing may have written between the goal's check and the lock; the plan must use the locked record.
                subtask.want = self._checked(request, self._read(request.model_name, record, 0.0))
            subtask.execute(request.model_name, record, say)
            finished = True
        except SubtaskCancelled:
            pass
        except RosError as error:
            failure = SubtaskFailed(error.reason)
        except SubtaskFailed as error:
            failure = error
        finally:
            stopped, cancelled = machine.release(), goal.cancelled.is_set()
            if lock is not None and not (self._plans and finished and not cancelled):
                lock.release()
            if not (finished or failure or cancelled):
                say.last(Internal(self._app.process.full))
        if not stopped:
            failure = SubtaskFailed(MotionNotEnded(self._app.machine))
        if failure is None or (cancelled and stopped):
            return Outcome.CANCELED if cancelled else Outcome.SUCCEEDED
        self._app.log.warning("failed", goal=goal.id, reason=failure.reason)
        say.last(failure.reason)
        return Outcome.ABORTED

    def _begin(self, goal: LeafGoal) -> tuple[Machine, Subtask]:
        """The machine for this goal, and the subtask; from now on a cancel reaches both."""
        app = self._app
        model, limit = app.site.model_of(app.machine), self._kind.timeout
        name = app.site.file.machines[app.machine].model
        machine = Machine(app.ros, app.machine, name, model, limit, goal.uuid, self._watched(), self._around)
        subtask = self._kind(machine, self._want, self._read, self._write)

        def cancel() -> None:
            subtask.on_cancel()
            machine.cancel()

        goal.on_cancel = cancel
        if goal.cancelled.is_set():
            cancel()
        return machine, subtask

    def _around(self) -> Yard:
        """Begin with the first goal that asks for it, as most subtasks never do."""
        self._yard = self._yard or Yard(self._app.ros, self._app.site)
        return self._yard

    def _watched(self) -> dict[str, Callable[[AnyPeer], None]]:
        """Begin with the first goal: the gateway's lease, ten times a second, must not wake an unused process."""
        if not self._watches:
            self._watches = {
                name: watch_server(self._app.ros, self._app.pulse, self._app.machine, name) for name in ("rc", "rp")
            }
            self._watches["ts"] = self._senders.add
        return self._watches

    def _read(self, model_name: str, record_name: str, max_age: float) -> dict[str, Value]:
        limit = max_age or self._max_age
        wanted = GetParameter.Request(model_name=model_name, record_name=record_name, max_age=limit)
        answer = self._app.ros.call(GetParameter, "/tms/db/get_parameter", wanted)
        if answer.error_code:
            raise SubtaskFailed(refusal(answer.error_code, answer.error_msg))
        return from_parameters(answer.record.values)

    def _write(self, model_name: str, record_name: str, values: Mapping[str, Value], create: bool) -> None:
        wanted = SetParameter.Request(
            model_name=model_name, record_name=record_name, source=self._app.process.full, create=create,
            values=to_parameters(values),
        )  # fmt: skip
        answer = self._app.ros.call(SetParameter, "/tms/db/set_parameter", wanted)
        if answer.error_code:
            raise SubtaskFailed(refusal(answer.error_code, answer.error_msg))


class _Feedback:
    """Progress texts of one goal, at a bounded rate; the last one carries the reason of a failure.

    A planner that was lost since its PC was busy goes on to report progress, from another thread.
    """

    def __init__(self, goal: LeafGoal) -> None:
        self._goal = goal
        self._next = 0.0
        self._saying = threading.Lock()

    def __call__(self, now: Reason | str) -> None:
        with self._saying:
            if monotonic() >= self._next:
                self._next = monotonic() + FEEDBACK_GAP
                self._goal.say(Foreign(now) if isinstance(now, str) else now)

    def last(self, reason: Reason) -> None:
        with self._saying:
            self._next = float("inf")
            self._goal.say(reason)
