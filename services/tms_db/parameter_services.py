"""The services for parameter records: reading, changing, batches of sensing, and the topic of changes.

All of them run on the executor thread, which keeps their order: a value that was read or acknowledged is never
followed by an older one.
"""

from collections.abc import Callable, Iterable
from datetime import datetime, timedelta

from tms_msg_db.msg import Record, RecordChanges, RecordUpdate, Refusal
from tms_msg_db.srv import (
    ChangeArray,
    FindRecord,
    GetParameter,
    ListParameterHistory,
    ListParameters,
    RemoveParameter,
    SetParameter,
    UpdateParameters,
)

from tms_config.clock import unix_time, utc_now
from tms_db import freshness, messages
from tms_db.answering import Answering
from tms_db.arrays import changed
from tms_db.batches import Batches, Update
from tms_db.connection import StoreConnection
from tms_db.parameter_history import ParameterHistory
from tms_db.parameters import Parameters, RecordEdit
from tms_db.reasons import RecordLocked
from tms_db.record_cache import Key, RecordCache
from tms_db.records import Document, check_values, models_of, title
from tms_db.store import Db
from tms_db.values import from_parameters
from tms_db.watching import Watching
from tms_machine.record_lock import FIELDS, holder
from tms_reason.errors import DbError
from tms_reason.wire import to_line
from tms_runtime.app import App

CHANGES_KEPT = 100  # messages that wait for a slow reader
OLDEST = 10 * 365 * 86400.0  # s; a larger age, or one that is no number, counts as this


class ParameterServices:
    """The services below /tms/db/ for parameter records."""

    def __init__(self, app: App, db: Db, connection: StoreConnection) -> None:
        self._app, self._ros = app, app.ros
        self._parameters = Parameters(db)
        self._batches = Batches(db, connection, app.log)
        self._watching = Watching(db, connection, app.log, lambda identity: self._heads.changed(identity))
        self._heads = RecordCache(self._parameters, self._batches.newest, app.ros, self._watching.sure)
        self._past = ParameterHistory(db, connection, app.log)
        self._changes = app.ros.publisher(RecordChanges, "/tms/db/changes", depth=CHANGES_KEPT)

    def offer(self, answering: Answering) -> None:
        answering.quick(GetParameter, "get_parameter", self.get)
        answering.slow(ListParameters, "list_parameters", self.list)
        answering.later(SetParameter, "set_parameter", self.set)
        answering.later(UpdateParameters, "update_parameters", self.update)
        answering.quick(ChangeArray, "change_array", self.change_array)
        answering.slow(FindRecord, "find_record", self.find)
        answering.quick(RemoveParameter, "remove_parameter", self.remove)
        answering.slow(ListParameterHistory, "list_parameter_history", self.history)
        self._batches.start()
        self._past.start()
        self._watching.start()
        self._app.on_stop(self._watching.stop)
        self._app.on_stop(self._past.stop)
        self._app.on_stop(self._batches.stop)

    def get(self, request: GetParameter.Request, response: GetParameter.Response) -> None:
        key = (request.model_name, request.record_name)
        document = self._heads.document(key)
        freshness.check(document, request.max_age)
        response.record = self._record({**document, "model_name": request.model_name})

    def list(self, request: ListParameters.Request, response: ListParameters.Response) -> None:
        response.records = [
            self._record(
                {**document, **self._batches.newest((model, str(document.get("record_name")))), "model_name": model}
            )
            for document in self._parameters.all(request.model_name)
            for model in models_of(document)
            if request.model_name in ("", model)
        ]

    async def set(self, request: SetParameter.Request, response: SetParameter.Response) -> None:
        key = (request.model_name, request.record_name)
        where = title(*key)
        change = RecordEdit(
            from_parameters(where, request.values), request.type, request.description, request.source,
            tuple(request.remove), request.max_age, from_parameters(where, request.expected),
        )  # fmt: skip
        if change.plain and self._may_batch(key):
            change.check(where)
            locks = bool(change.values) and FIELDS.issuperset(change.values)
            stamp = None if locks else _now()  # a lock gives the record no new values
            update = Update(self._heads.get(key).id, dict(change.values), stamp, request.source)
            await self._put({key: update}, hurry=True)
        else:
            self._batches.settle(key)
            response.created = self._parameters.set(*key, change, request.create)
            self._heads.forget()
            self._past.note(key, _now(), request.source, change.values)
            self._report([key])

    async def update(self, request: UpdateParameters.Request, response: UpdateParameters.Response) -> None:
        taken: dict[Key, Update] = {}
        for index, wanted in enumerate(request.updates):
            key = (wanted.model_name, wanted.record_name)
            try:
                self._take(taken, key, wanted)
            except DbError as error:
                if error.code == "STORE_DOWN":
                    raise
                response.refused.append(Refusal(index=index, code=error.code, text=to_line(error.reason)))
        if taken:
            await self._put(taken, hurry=False)

    def change_array(self, request: ChangeArray.Request, _: ChangeArray.Response) -> None:
        key = (request.model_name, request.record_name)
        values = from_parameters(title(*key), [request.value])
        self._batches.settle(key)
        ((name, value),) = values.items()
        array = self._parameters.change_array(key, name, changed(request.change, value), request.source)
        self._heads.forget()
        self._past.note(key, _now(), request.source, {name: array})
        self._report([key])

    def find(self, request: FindRecord.Request, response: FindRecord.Response) -> None:
        response.found = self._parameters.holds(from_parameters("find_record", request.values))

    def remove(self, request: RemoveParameter.Request, _: RemoveParameter.Response) -> None:
        key = (request.model_name, request.record_name)
        self._batches.settle(key)
        self._parameters.remove(*key)
        self._heads.forget()
        self._report([key])
        self._app.log.info("removed", reason=title(*key))

    def history(self, request: ListParameterHistory.Request, response: ListParameterHistory.Response) -> None:
        key = (request.model_name, request.record_name)
        response.changes = [messages.past(change) for change in self._past.changes(key, request.limit)]
        if not response.changes:
            self._parameters.get(*key)  # raises RECORD_MISSING when there is no such record

    def _take(self, taken: dict[Key, Update], key: Key, wanted: RecordUpdate) -> None:
        """Take one update of a batch."""
        if self._batches.gone.is_set():
            self._batches.gone.clear()
            self._heads.forget()
        where = title(*key)
        values = from_parameters(where, wanted.values)
        check_values(where, values)
        head = self._heads.dynamic(key)
        if (owner := holder(head.document, unix_time())) is not None:
            raise DbError(RecordLocked(where, owner))
        fitting = head.fit(where, values, wanted.loose)
        fields = {name: value for name, value in fitting.items() if name not in wanted.keep}
        stamp = _now() - timedelta(seconds=max(0.0, wanted.age if wanted.age < OLDEST else OLDEST))
        if wanted.expected:  # only the store can compare and write in one step
            self._batches.settle(key)
            change = RecordEdit(fields, source=wanted.source, expected=from_parameters(where, wanted.expected))
            self._parameters.set(*key, change)
            self._heads.forget()
            self._past.note(key, stamp, wanted.source, fields, often=True)
            self._report([key])
            return
        if key in taken:
            fields = {**taken[key].fields, **fields}
        taken[key] = Update(head.id, fields, stamp, wanted.source)

    def _may_batch(self, key: Key) -> bool:
        try:
            return self._heads.get(key).type != "static"
        except DbError as error:
            if error.code == "RECORD_MISSING":
                return False  # to be made, or to be refused by the store
            raise

    async def _put(self, updates: dict[Key, Update], hurry: bool) -> None:
        """Make updates readable, and wait until they are stored.

        Raises:
            DbError: the store is away.
        """
        settled = self._ros.create_future()
        report: Callable[[DbError | None], None] = lambda problem: self._ros.on_executor(  # noqa: E731
            lambda: settled.set_result(problem)
        )
        self._batches.put(updates, report, hurry)
        for key, update in updates.items():
            self._heads.get(key).change(update.stored())
            self._past.note(key, update.updated_at or _now(), update.source, update.fields, often=not hurry)
        self._report(updates)
        problem = await settled
        if problem is not None:
            self._heads.forget()
            raise DbError(problem.reason, problem.code)

    def _report(self, keys: Iterable[Key]) -> None:
        """Publish that records have changed, so that readers of shared records read them again."""
        names = [name for model, name in keys if not model]
        if names:
            self._changes.publish(RecordChanges(record_names=names))

    def _record(self, document: Document) -> Record:
        message, left_out = messages.record(document)
        if left_out:
            where = title(message.model_name, message.record_name)
            self._app.log.warning("left_out", record=where, fields=left_out, reason="no ROS type for them")
        return message


def _now() -> datetime:
    return utc_now()
