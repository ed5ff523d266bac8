"""Recordings over ROS, for the API."""

from array import array
from datetime import datetime

from builtin_interfaces.msg import Time
from tms_msg_db import msg
from tms_msg_db.srv import ReadRecording

from tms_config.clock import utc_now
from tms_db import store
from tms_db.answering import Answering
from tms_db.recordings import MOST_POINTS, POINTS, Recordings, Series
from tms_db.values import from_time


class RecordingServices:
    """Each call has a thread of its own: a recording has megabytes."""

    def __init__(self, db: store.Db) -> None:
        self._recordings = Recordings(db)

    def offer(self, answering: Answering) -> None:
        answering.slow(ReadRecording, "read_recording", self.read)

    def read(self, request: ReadRecording.Request, response: ReadRecording.Response) -> None:
        begin, end = self._recordings.span(request.run_id) if request.run_id else _span(request.begin, request.end)
        machines = [request.machine] if request.machine else self._recordings.machines(begin, end)
        points = min(request.points or POINTS, MOST_POINTS)
        response.series = [
            _message(series)
            for machine in machines
            for series in self._recordings.read(machine, begin, end, points)
        ]  # fmt: skip


def _span(begin: Time, end: Time) -> tuple[datetime, datetime]:
    """The times of a request; no end means now."""
    return from_time(begin), from_time(end) if end.sec or end.nanosec else utc_now()


def _message(series: Series) -> msg.RecordedSeries:
    return msg.RecordedSeries(
        machine=series.machine, kind=series.kind, names=list(series.names),
        times=array("d", series.rows[:, 0].tobytes()), values=array("d", series.rows[:, 1:].tobytes()),
    )  # fmt: skip
