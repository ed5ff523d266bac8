"""The process of a subtask: what it locks and frees, and what a cancel reaches."""

import asyncio
import threading
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest
import structlog
from tms_msg_db.msg import Record
from tms_msg_db.srv import GetParameter, SetParameter
from tms_msg_ts.action import LeafNodeBase

from tms_kit import subtask_server
from tms_kit.subtask import Params, Progress, Subtask
from tms_kit.subtask_server import _Server
from tms_machine.reasons import BadRecord, Busy, InputsNotTaken
from tms_machine.record_lock import FLAG
from tms_machine.values import from_parameters, to_parameters
from tms_reason.errors import SubtaskFailed
from tms_reason.reason import Reason
from tms_reason.reasons import MustBeNumber
from tms_reason.wire import to_line
from tms_ros.goals import Outcome

REQUEST = LeafNodeBase.Goal(model_name="zx200", record_name="p")


class Place(Params):
    x: float


class Dig(Subtask):
    """Notes where it digs."""

    params = Place
    dug: list[float]  # set by the test
    cancels: list[str]

    def execute(self, model_name: str, record_name: str, progress: Progress) -> None:
        self.dug.append(self.want.x)

    def on_cancel(self) -> None:
        self.cancels.append("heard")


class Goal:
    """As the runtime hands it to a worker."""

    def __init__(self, cancelled: bool = False) -> None:
        self.request, self.id, self.uuid = REQUEST, "g1", bytes(16)
        self.cancelled, self.on_cancel, self.said = threading.Event(), None, list[str]()
        if cancelled:
            self.cancelled.set()

    def say(self, reason: Reason) -> None:
        self.said.append(to_line(reason))


class Database:
    """One dynamic record with a lock flag; `next` is what sensing writes as soon as it has been read."""

    def __init__(self, x: Any, *following: Any) -> None:
        self.x, self.next = x, list(following)
        self.lock: list[bool] = []
        self.asked: list[Any] = []  # machine and record of each reading

    def _answer(self) -> Any:
        record = Record(type="dynamic", values=to_parameters({"x": self.x, FLAG: False}))
        self.x = self.next.pop(0) if self.next else self.x
        return GetParameter.Response(record=record)

    async def call_async(self, service: Any, _name: str, request: Any, *_limit: Any) -> Any:
        self.asked.append((request.model_name, request.record_name))
        return self._answer()

    def call(self, service: Any, _name: str, request: Any, *_limit: Any) -> Any:
        if service is GetParameter:
            self.asked.append((request.model_name, request.record_name))
            return self._answer()
        self.lock.append(bool(from_parameters(request.values)[FLAG]))
        return SetParameter.Response()

    def call_unanswered(self, service: Any, name: str, request: Any) -> None:
        self.call(service, name, request)


def served(database: Database, plan_only: bool) -> Any:
    """The server of Dig on this database, and the class that notes what it did."""
    nothing: Any = SimpleNamespace(lease_publisher=lambda *_: None, lease_subscribe=lambda *_: None)
    ros: Any = SimpleNamespace(**vars(nothing), call_async=database.call_async, call=database.call)
    ros.call_unanswered = database.call_unanswered
    site = SimpleNamespace(
        file=SimpleNamespace(machines={"zx200": SimpleNamespace(model="zx200")}),
        model_of=lambda _: None,
        other_form=lambda _: "",
    )
    app: Any = SimpleNamespace(
        ros=ros, pulse=None, machine="zx200", site=site, log=structlog.stdlib.get_logger("test"),
        process=SimpleNamespace(full="zx200:subtask_dig", action="subtask_dig"),
    )  # fmt: skip
    kind = type("Noted", (Dig,), {"dug": [], "cancels": []})
    return _Server(app, kind, {"plan_only": plan_only}, 0.0), kind


def accepted(server: Any) -> Any:
    return asyncio.run(server.accept(REQUEST))


def test_what_was_locked_is_what_is_planned() -> None:
    database = Database(1.0, 2.0)  # sensing wrote between the check of the goal and the lock
    server, kind = served(database, plan_only=True)
    assert accepted(server) is None
    assert server._execute(Goal()) is Outcome.SUCCEEDED
    assert kind.dug == [2.0]
    assert database.lock == [True]  # kept for the variant that moves


def test_a_plan_whose_cancel_came_as_it_ended_frees_the_record() -> None:
    database, goal = Database(1.0), Goal()
    server, kind = served(database, plan_only=True)
    kind.execute = lambda *_: goal.cancelled.set()
    assert accepted(server) is None
    assert server._execute(goal) is Outcome.CANCELED
    assert database.lock == [True, False]


def test_a_motion_frees_the_record_however_it_ends() -> None:
    database = Database(1.0)
    server, kind = served(database, plan_only=False)

    def fails(*_: Any) -> None:
        raise SubtaskFailed("too far")

    kind.execute = fails
    goal = Goal()
    assert accepted(server) is None
    assert server._execute(goal) is Outcome.ABORTED
    assert goal.said == ['FOREIGN words="too far"']
    assert database.lock == [False]


def test_progress_that_comes_after_the_reason_of_a_failure_does_not_hide_it() -> None:
    server, kind = served(Database(1.0), plan_only=False)
    tell: list[Any] = []

    def fails(*words: Any) -> None:
        tell.append(words[-1])
        raise SubtaskFailed("too far")

    kind.execute = fails
    goal = Goal()
    assert accepted(server) is None
    assert server._execute(goal) is Outcome.ABORTED
    tell[0]("move 2 of 3")  # of a planner that was taken for lost
    assert goal.said == ['FOREIGN words="too far"']


@pytest.mark.parametrize(("plan_only", "freed"), [(False, [False]), (True, [])])
def test_a_motion_that_is_refused_for_its_record_frees_it(plan_only: bool, freed: list[bool]) -> None:
    database = Database("far")
    server, _ = served(database, plan_only)
    refusal = accepted(server)
    assert isinstance(refusal, BadRecord) and refusal.record == "zx200/p"
    assert refusal.find(MustBeNumber) is not None and refusal.problem.args["key"] == "x"
    assert database.lock == freed
    assert not server._reserved


class Way(Place):
    read_direction: str = ""


@pytest.mark.parametrize(("params", "taken"), [(Place, False), (Way, True), (None, False)])
def test_inputs_of_a_goal_reach_the_subtask_or_refuse_it(params: type[Params] | None, taken: bool) -> None:
    server, kind = served(Database(1.0), plan_only=False)
    kind.params = params
    request = LeafNodeBase.Goal(model_name="zx200", record_name="p?read_direction=down")
    refusal = asyncio.run(server.accept(request))
    assert refusal == (None if taken else InputsNotTaken(("read_direction",)))
    assert not taken or (server._want.x, server._want.read_direction) == (1.0, "down")


class Previous(Params):
    previous_target_record_name: str = ""


def test_a_goal_whose_parameters_all_come_from_the_leaf_names_whatever_records_it_wants() -> None:
    database = Database(1.0)
    server, kind = served(database, plan_only=True)
    server._inputs = {}
    kind.params = Previous
    goal = Goal()
    goal.request = LeafNodeBase.Goal(model_name="zx200", record_name="A,B?previous_target_record_name=Z")
    seen = list[Any]()
    kind.execute = lambda self, *names: seen.append((self.want.previous_target_record_name, *names[:2]))
    assert asyncio.run(server.accept(goal.request)) is None
    assert server._execute(goal) is Outcome.SUCCEEDED
    assert seen == [("Z", "zx200", "A,B")] and database.asked == []


def test_a_subtask_writes_into_a_record() -> None:
    database = Database(1.0)
    server, kind = served(database, plan_only=True)
    kind.execute = lambda self, model, record, _: self.set_param_in_db(model, record, {FLAG: False, "plan": {"a": 1}})
    assert accepted(server) is None
    assert server._execute(Goal()) is Outcome.SUCCEEDED
    assert database.lock == [True, False]  # the lock, then what the subtask has written


def test_the_database_is_asked_for_the_record_without_the_inputs() -> None:
    database, seen = Database(1.0), list[Any]()
    server, kind = served(database, plan_only=True)
    kind.params = Way
    kind.execute = lambda _, *names: seen.append(names[:2])
    database.asked = seen
    goal = Goal()
    goal.request = LeafNodeBase.Goal(model_name="zx200", record_name="p?read_direction=down")
    assert asyncio.run(server.accept(goal.request)) is None
    assert server._execute(goal) is Outcome.SUCCEEDED
    assert seen == [("zx200", "p"), ("zx200", "p"), ("zx200", "p")]  # before the goal, under the lock, the subtask


def test_a_cancel_that_came_first_reaches_the_subtask() -> None:
    server, kind = served(Database(1.0), plan_only=False)
    assert accepted(server) is None
    assert server._execute(Goal(cancelled=True)) is Outcome.CANCELED
    assert kind.cancels == ["heard"]


@pytest.mark.parametrize("gone", [True, False])
def test_a_goal_waits_for_the_end_of_one_whose_scheduler_is_gone(gone: bool) -> None:
    server, _ = served(Database(1.0), plan_only=False)
    assert accepted(server) is None
    waits: list[float] = []

    def after(seconds: float, step: Callable[[], None]) -> None:
        waits.append(seconds)
        server._reserved = len(waits) < 3
        step()

    server._senders = SimpleNamespace(gone=gone)
    server._app.ros.create_future, server._app.ros.after = asyncio.Future, after
    assert (accepted(server) is None) == gone
    assert len(waits) == (3 if gone else 0)


def test_it_does_not_wait_for_ever(monkeypatch: pytest.MonkeyPatch) -> None:
    server, _ = served(Database(1.0), plan_only=False)
    assert accepted(server) is None
    now = iter(range(100))
    monkeypatch.setattr(subtask_server, "monotonic", lambda: float(next(now)))
    server._senders = SimpleNamespace(gone=True)
    server._app.ros.create_future, server._app.ros.after = asyncio.Future, lambda _, step: step()
    assert accepted(server) == Busy("zx200:subtask_dig")
