"""Grounds over ROS, for tms:ground: it stores its own, and reads those that others have stored."""

from tms_msg_ground.srv import ReadSnapshot, WriteSnapshot

from tms_db import store
from tms_db.answering import Answering
from tms_db.ground import GroundSnapshots, chosen
from tms_db.reasons import GroundNotHeights
from tms_db.values import date_of, to_time
from tms_reason.errors import DbError
from tms_runtime.app import App
from tms_soil import patches


class GroundServices:
    """Each call has a thread of its own: a ground has megabytes."""

    def __init__(self, app: App, db: store.Db) -> None:
        self._app, self._grounds = app, GroundSnapshots(db)

    def offer(self, answering: Answering) -> None:
        answering.slow(WriteSnapshot, "write_snapshot", self.write)
        answering.slow(ReadSnapshot, "read_snapshot", self.read)

    def write(self, request: WriteSnapshot.Request, response: WriteSnapshot.Response) -> None:
        try:
            ground = patches.heights(request.ground)
        except ValueError as error:
            raise DbError(GroundNotHeights(str(error))) from error
        stored = self._grounds.add(ground, request.source)
        response.taken_at = stored.taken_at.isoformat()
        self._app.log.info("ground_stored", taken_at=response.taken_at, source=request.source)

    def read(self, request: ReadSnapshot.Request, response: ReadSnapshot.Response) -> None:
        """Answer with a ground; where none was taken after the time that is asked for, with an empty `taken_at`."""
        after = date_of(request.after) if request.after else None
        until = date_of(request.until) if request.until else None
        known = [one for one in self._grounds.all() if after is None or one.taken_at > after]
        if after is not None and not known:
            return
        found = chosen([one for one in known if until is None or one.taken_at <= until], request.snapshot)
        later = [one.taken_at.isoformat() for one in known if one.taken_at > found.taken_at]
        response.next_at = later[-1] if later else ""  # the newest is first
        response.ground = patches.patch(self._grounds.read(found))
        response.ground.header.stamp = to_time(found.taken_at)
        response.taken_at, response.source = found.taken_at.isoformat(), found.source
