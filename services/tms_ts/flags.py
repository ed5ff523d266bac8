"""Shared flags (the global blackboard) for tree nodes: reads and writes through tms:db, without waiting."""

from collections.abc import Callable, Mapping
from typing import Any, Generic, TypeVar

from tms_msg_db.srv import ChangeArray, FindRecord, GetParameter, SetParameter

from tms_interfaces.generated import Reply, Req, ServiceType
from tms_machine.reasons import NoDatabase
from tms_machine.values import from_parameters, to_parameters
from tms_reason.reason import Reason
from tms_reason.wire import refusal
from tms_ros.node import Ros
from tms_ts.reasons import NoRecordField
from tms_ts.shared_records import SharedRecords
from tms_ts.world import Value

T = TypeVar("T")
DATABASE_LIMIT = 5.0  # s for the database to answer


class Answer(Generic[T]):
    """An answer that comes later and then wakes the run."""

    def __init__(self) -> None:
        self.done = False
        self.error: Reason | None = None
        self._value: list[T] = []

    @property
    def value(self) -> T:
        return self._value[0]

    def settle(self, value: T) -> None:
        self._value, self.done = [value], True

    def fail(self, error: Reason) -> None:
        self.error, self.done = error, True


class Flags:
    """Access to records without a machine, which all tasks share."""

    def __init__(self, ros: Ros, records: SharedRecords, wake: Callable[[], None], run_id: str) -> None:
        self._ros, self._records, self._wake, self._source = ros, records, wake, f"run {run_id}"

    def close(self) -> None:
        """End the access, as the run is over."""
        self._records.unwatch(self._wake)

    def read(self, record: str, field: str) -> Answer[Any]:
        """The value of one field; a missing or stale record or a missing field is an error."""
        answer: Answer[Any] = Answer()
        self._records.watch(record, self._wake)
        known = self._records.kept(record)
        if known is not None:
            _settle(answer, record, field, known)
            return answer
        asked = self._records.asked(record)
        request = GetParameter.Request(model_name="", record_name=record)

        def settle(response: GetParameter.Response) -> None:
            fields = from_parameters(response.record.values)
            self._records.keep(record, asked, fields, response.record.max_age)
            _settle(answer, record, field, fields)

        self._ask(answer, GetParameter, "/tms/db/get_parameter", request, settle)
        return answer

    def write(self, record: str, field: str, value: Value, expected: Value | None = None) -> Answer[None]:
        """Set one field of an existing record in one atomic step; with `expected` only if it holds that value."""
        answer: Answer[None] = Answer()
        request = SetParameter.Request(record_name=record, source=self._source, values=to_parameters({field: value}))
        if expected is not None:
            request.expected = to_parameters({field: expected})

        def settle(_: SetParameter.Response) -> None:
            self._records.forget(record)
            answer.settle(None)

        self._ask(answer, SetParameter, "/tms/db/set_parameter", request, settle)
        return answer

    def change_array(self, record: str, field: str, change: str, value: Value) -> Answer[None]:
        """Change an array in one field of an existing record in one atomic step."""
        answer: Answer[None] = Answer()
        values = to_parameters({field: value})
        request = ChangeArray.Request(record_name=record, source=self._source, change=change, value=values[0])

        def settle(_: ChangeArray.Response) -> None:
            self._records.forget(record)
            answer.settle(None)

        self._ask(answer, ChangeArray, "/tms/db/change_array", request, settle)
        return answer

    def find(self, values: Mapping[str, Value]) -> Answer[bool]:
        """Whether a record has all these values."""
        answer: Answer[bool] = Answer()
        request = FindRecord.Request(values=to_parameters(values))
        self._ask(answer, FindRecord, "/tms/db/find_record", request, lambda found: answer.settle(found.found))
        return answer

    def _ask(
        self,
        answer: Answer[T],
        service: ServiceType[Req, Reply],
        name: str,
        request: Req,
        settle: Callable[[Reply], None],
    ) -> None:
        async def ask() -> None:
            response = await self._ros.call_async(service, name, request, DATABASE_LIMIT)
            if response is None:
                answer.fail(NoDatabase("tms:db"))
            elif response.error_code:
                answer.fail(refusal(response.error_code, response.error_msg))
            else:
                settle(response)
            self._wake()

        self._ros.start(ask)


def _settle(answer: Answer[Any], record: str, field: str, fields: Mapping[str, Any]) -> None:
    if field in fields:
        answer.settle(fields[field])
    else:
        answer.fail(NoRecordField(record, field))
