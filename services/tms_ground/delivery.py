"""Sends finished cycles to the database; they wait on the disk while it is away."""

from tms_msg_db.msg import MachineState
from tms_msg_db.srv import WriteMachineStates

from tms_ground.reasons import CycleLost, CyclesMany
from tms_ground.waiting import LOST, Waiting
from tms_machine.stamps import time
from tms_reason.errors import DbError, RosError
from tms_reason.wire import refusal
from tms_ros.node import Ros
from tms_runtime.log import Logger
from tms_work.cycle import Cycle

COLLECTION = "cycle"
BATCH = 100  # cycles in one request
REFUSED = {"BAD_CYCLE", "BAD_RECORD"}  # for good; any other error passes, or a person repairs the store


class Delivery:
    """Sends what is on the disk, a batch at a time."""

    def __init__(self, ros: Ros, log: Logger, waiting: Waiting) -> None:
        self._ros, self._log, self._waiting = ros, log, waiting
        self._away = False  # the database is away, and that is logged
        self._most = BATCH

    def send(self) -> None:
        """Send until nothing is left, or something goes wrong; then the next call goes on."""
        if lost := self._waiting.lost():
            self._log.error("cycles_lost", reason=CyclesMany(lost))
        while batch := self._waiting.batch(self._most):
            problem = self._write(batch)
            if problem is None:
                self._waiting.done(batch)
                self._most, self._away = BATCH, False
            elif problem.code not in REFUSED:
                if not self._away:
                    self._log.warning("cycles_wait", reason=problem.reason)
                self._away = True
                return
            elif len(batch) > 1:
                self._most = 1  # one by one, to find the one that is refused
            else:
                self._waiting.done(batch)
                LOST.inc()
                self._log.error("cycle_lost", reason=CycleLost(problem.reason))

    def _write(self, batch: list[str]) -> DbError | RosError | None:
        """Why they could not be written; None if they were."""
        request = WriteMachineStates.Request(states=[_message(one) for one in batch])
        try:
            answer = self._ros.call(WriteMachineStates, "/tms/db/write_machine_states", request)
        except RosError as error:
            return error
        if not answer.error_code:
            return None
        return DbError(refusal(answer.error_code, answer.error_msg), answer.error_code)


def _message(text: str) -> MachineState:
    cycle = Cycle.model_validate_json(text)
    return MachineState(collection=COLLECTION, machine=cycle.machine, stamp=time(cycle.ended_at.timestamp()), msg=text)
