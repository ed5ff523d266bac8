"""Cycles of work over ROS, for the API."""

from tms_msg_db.srv import ListCycles

from tms_db import store
from tms_db.answering import Answering
from tms_db.cycles import Cycles
from tms_db.values import date_of


class WorkServices:
    """Each call has a thread of its own: a day has thousands of cycles."""

    def __init__(self, db: store.Db) -> None:
        self._cycles = Cycles(db)

    def offer(self, answering: Answering) -> None:
        answering.slow(ListCycles, "list_cycles", self.read)

    def read(self, request: ListCycles.Request, response: ListCycles.Response) -> None:
        found = self._cycles.find(begin=date_of(request.begin), end=date_of(request.end))
        response.cycles = [one.model_dump_json() for one in found]
