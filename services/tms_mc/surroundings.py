"""What stands around a machine that drives: the other machines of the site, and the blocked areas of the database."""

from tms_msg_db.srv import GetParameter

from tms_config.clock import monotonic
from tms_control.from_above import from_above
from tms_control.ground import Body, Ground
from tms_control.path import Pose
from tms_control.reasons import MachineThere
from tms_machine.drift import drift
from tms_machine.places import PERIOD, Places
from tms_machine.values import from_parameters
from tms_mc.blocked_areas import RECORD, areas
from tms_mc.reasons import AreasUnread
from tms_reason.errors import RosError, SubtaskFailed
from tms_reason.reason import Reason
from tms_reason.wire import refusal
from tms_runtime.app import App

SERVICE = "/tms/db/get_parameter"
LIMIT = 0.8  # s for the database to answer
NONE = "RECORD_MISSING"  # its code where nobody has stored such a record


class Surroundings:
    """A machine that has told no place, or has no footprint, is left out."""

    def __init__(self, app: App) -> None:
        self._app = app
        models = {name: app.site.model_of(name) for name in app.site.file.machines if name != app.machine}
        self._models = {name: model for name, model in models.items() if model.footprint}
        self._places = Places(app.ros, {name: app.site.border(name) for name in self._models})
        self._shapes = {name: from_above(model) for name, model in self._models.items()}
        self._areas: list[Body] = []
        app.ros.prepare(GetParameter, SERVICE)
        if self._models:
            app.ros.poll_in_thread(PERIOD, self._places.take, "places")

    def read(self) -> None:
        """Read the blocked areas anew; while the database is away, those that were read last hold.

        Raises:
            SubtaskFailed: BadRecord; or the record is older than it may be.
        """
        if not self._app.ros.has_service(GetParameter, SERVICE):
            return
        try:
            answer = self._app.ros.call(GetParameter, SERVICE, GetParameter.Request(record_name=RECORD), LIMIT)
        except RosError as error:
            return self._unread(error.reason)
        if answer.error_code == "STALE_RECORD":
            raise SubtaskFailed(refusal(answer.error_code, answer.error_msg))
        if answer.error_code not in ("", NONE):
            return self._unread(refusal(answer.error_code, answer.error_msg))
        self._areas = areas(from_parameters(answer.record.values))
        return None

    def ground(self) -> Ground:
        """All of it now: machines where they were told to be last, and how far they may have moved since."""
        now = monotonic()
        found = [
            Body.of(MachineThere(name), part, Pose(*place[:3]), drift(model, now - place.received))
            for name, model in self._models.items()
            if (place := self._places.place(name)) is not None
            for part in self._shapes[name].values()
        ]
        return Ground((*found, *self._areas))

    def _unread(self, why: Reason) -> None:
        self._app.log.warning("areas_unread", reason=AreasUnread(why))
