"""Grounds in the database: the newest one is taken where nothing newer is known, and ours are stored there."""

import threading
from datetime import date, datetime, timedelta

from tms_msg_ground.srv import ReadSnapshot, TakeSnapshot, WriteSnapshot

from tms_config.clock import utc_now
from tms_ground.reasons import GroundFromFuture
from tms_ground.watching import GroundWatch
from tms_machine.asking import ask
from tms_reason.errors import TmsError
from tms_reason.reason import Reason
from tms_reason.wire import refusal, to_line
from tms_runtime.app import App
from tms_soil import patches
from tms_soil.patches import EACH_HOUR

SERVICE = "/tms/ground/take_snapshot"
READ, WRITE = "/tms/db/read_snapshot", "/tms/db/write_snapshot"
PERIOD = 10.0  # s between two looks for a ground that somebody has stored
LIMIT = 60.0  # s for the database: a ground has megabytes
AHEAD = timedelta(seconds=5)  # that clocks of two PCs may differ
NONE = "GROUND_NOT_THERE"
END_OF_DAY = "end of the day"
HOUR = timedelta(hours=1)  # after which a ground that has changed is stored


class Snapshots:
    """Of one site."""

    def __init__(self, app: App, watch: GroundWatch, lock: threading.Lock) -> None:
        """`lock`: while it is held, the ground does not change."""
        self._ros, self._log, self._watch, self._lock = app.ros, app.log, watch, lock
        self._day = _today()  # that a snapshot will close
        self._stored_at = utc_now()  # when our last one was
        self._own = set[str]()  # times of what we have stored ourselves
        self._told: Reason | None = None  # why not, as it was told last
        app.ros.prepare(ReadSnapshot, READ)
        app.ros.prepare(WriteSnapshot, WRITE)
        app.ros.offer_slow(TakeSnapshot, SERVICE, self.take)
        app.ros.poll_in_thread(PERIOD, self.look, "ground_snapshots")

    def look(self) -> None:
        """Take what others have stored since the last look; each hour and at the end of a day, store the ground."""
        if not self._ros.has_service(ReadSnapshot, READ):
            return
        try:
            while self._read():
                pass
            if _today() != self._day and (not self._watch.touched or self._write(END_OF_DAY)):
                self._day = _today()
            if self._watch.touched and utc_now() - self._stored_at >= HOUR:
                self._write(EACH_HOUR)
            self._told = None
        except TmsError as error:  # the next look tries again
            if error.reason != self._told:
                self._told = error.reason
                self._log.warning("snapshots_wait", reason=error.reason)

    def take(self, request: TakeSnapshot.Request, response: TakeSnapshot.Response) -> TakeSnapshot.Response:
        """Store the ground of now."""
        try:
            response.taken_at = self._write(request.source)
        except TmsError as error:
            response.error_code, response.error_msg = error.code, to_line(error.reason)
        return response

    def _read(self) -> bool:
        """Take the next ground that is newer than those that we know; whether there was one.

        Raises:
            TmsError: the database is away or refuses, or the time of that ground has not come yet.
        """
        after = self._watch.newest
        request = ReadSnapshot.Request(snapshot="first" if after else "last", after=after)
        answer = self._ros.call(ReadSnapshot, READ, request, LIMIT)
        if answer.error_code == NONE or not (answer.error_code or answer.taken_at):
            return False
        if answer.error_code:
            raise TmsError(refusal(answer.error_code, answer.error_msg), answer.error_code)
        taken = datetime.fromisoformat(answer.taken_at)
        if taken > utc_now() + AHEAD:
            raise TmsError(GroundFromFuture(answer.taken_at, answer.source))
        with self._lock:
            if answer.taken_at not in self._own:
                self._watch.measured(patches.heights(answer.ground), taken.timestamp())
            self._watch.newest = answer.taken_at
            self._own.discard(answer.taken_at)
        self._log.info("snapshot_known", taken_at=answer.taken_at, source=answer.source)
        return True

    def _write(self, source: str) -> str:
        """Store the ground; returns the time that the database has given it.

        Raises:
            TmsError: the database is away or refuses.
        """
        with self._lock:
            message = patches.patch(self._watch.earth.grid.heights(self._watch.area))
            self._watch.touched = False
        try:
            answer = ask(self._ros, WriteSnapshot, WRITE, WriteSnapshot.Request(ground=message, source=source), LIMIT)
        except TmsError:
            self._watch.touched = True
            raise
        self._own.add(answer.taken_at)
        self._stored_at = utc_now()
        self._log.info("snapshot_stored", taken_at=answer.taken_at, source=source)
        return answer.taken_at


def _today() -> date:
    return utc_now().astimezone().date()
