"""Records that a motion controller reads at the begin of a goal."""

from collections.abc import Mapping

from tms_msg_db.srv import GetParameter

from tms_machine.values import Value, from_parameters
from tms_reason.errors import RosError, SubtaskFailed
from tms_reason.wire import refusal
from tms_runtime.app import App

SERVICE = "/tms/db/get_parameter"
LIMIT = 0.8  # s for the database to answer
NONE = "RECORD_MISSING"  # its code where nobody has stored such a record


class Records:
    """Asks the database."""

    def __init__(self, app: App) -> None:
        self._ros = app.ros
        app.ros.prepare(GetParameter, SERVICE)

    def there(self) -> bool:
        """Whether the database can be asked."""
        return self._ros.has_service(GetParameter, SERVICE)

    def read(self, record: str, machine: str = "") -> Mapping[str, Value] | None:
        """The values of a record, of a machine or shared; None: there is none.

        Raises:
            SubtaskFailed: it is older than it may be.
            RosError: the database does not tell.
        """
        request = GetParameter.Request(model_name=machine, record_name=record)
        answer = self._ros.call(GetParameter, SERVICE, request, LIMIT)
        if answer.error_code == NONE:
            return None
        if answer.error_code:
            why = refusal(answer.error_code, answer.error_msg)
            raise SubtaskFailed(why) if answer.error_code == "STALE_RECORD" else RosError(why)
        return from_parameters(answer.record.values)
