"""Reads the scene records of a machine from the database, for each plan anew."""

from tms_msg_db.msg import Record
from tms_msg_db.srv import ListParameters

from tms_config.clock import unix_time
from tms_machine import stamps
from tms_machine.values import from_parameters
from tms_reason.errors import RosError
from tms_reason.reason import Reason
from tms_reason.wire import refusal
from tms_rp.reasons import SceneUnread
from tms_rp.scene import Obstacle
from tms_rp.scene_records import PREFIX, SceneRecord
from tms_runtime.app import App

SERVICE = "/tms/db/list_parameters"
LIMIT = 0.8  # s for the database to answer


class ToldScene:
    """What the records of one machine tell. While the database is away, what they told last, which gets older."""

    def __init__(self, app: App) -> None:
        self._app = app
        self._models = {one.model: app.site.model_of(name) for name, one in app.site.file.machines.items()}
        self._models |= {name: app.site.model_of(name) for name in app.site.file.machines}
        self._records: list[Record] = []
        app.ros.prepare(ListParameters, SERVICE)

    def obstacles(self) -> list[Obstacle]:
        """What stands there now.

        Raises:
            SubtaskFailed: BadRecord, SceneRecordOld.
        """
        if self._app.ros.has_service(ListParameters, SERVICE):
            self._read()
        now = unix_time()
        return [obstacle for one in self._records for obstacle in _record(one, now).obstacles(self._models)]

    def _read(self) -> None:
        request = ListParameters.Request(model_name=self._app.machine)
        try:
            answer = self._app.ros.call(ListParameters, SERVICE, request, LIMIT)
        except RosError as error:
            return self._unread(error.reason)
        if answer.error_code:
            return self._unread(refusal(answer.error_code, answer.error_msg))
        self._records = [one for one in answer.records if one.record_name.startswith(PREFIX)]
        return None

    def _unread(self, why: Reason) -> None:
        self._app.log.warning("scene_unread", reason=SceneUnread(why))


def _record(message: Record, now: float) -> SceneRecord:
    age = now - stamps.seconds(message.updated_at)
    values = from_parameters(message.values)
    return SceneRecord(message.record_name, values, age, message.max_age, message.type == "dynamic")
