"""Choose where the excavator digs next, by the ground as it is now, and write it for excavate_simple; nothing moves."""

from typing import Any

from tms_kit.reasons import NoDigPlanned, NothingToDig
from tms_kit.subtask import Progress, Subtask, SubtaskFailed
from tms_machine.reasons import Aborted
from tms_reason.reason import Reason
from tms_soil.dig_point import DigPoint
from tms_subtasks.records.digging_place import left_to_dig
from tms_subtasks.records.earthwork import DIG, Earthwork, bucket_of, earthwork_of, fruitless, job_of

TRIES = 100  # places that the planner is asked about, some tenths of a second each; late in a job few can be dug
THETA_W = 0.9  # rad, wished angle of the bucket; the planner takes the nearest one


class ChooseDigPoint(Subtask):
    """Most soil for the time that it takes, in reach and away from other machines, where the planner finds a motion."""

    timeout = 120.0
    params = Earthwork

    def execute(self, model_name: str, record_name: str, progress: Progress) -> None:
        work = earthwork_of(self.get_param_from_db, model_name, record_name)
        last = bucket_of(self.get_param_from_db, model_name)
        (own,) = self.machine.yard.loads([self.machine.name], self.machine.check)
        empty = fruitless(self.get_param_from_db, model_name)
        found = left_to_dig(self.machine, work, own.capacity, last.bearing, [one.point for one in empty])
        if not found:
            raise SubtaskFailed(NothingToDig(self.machine.name, record_name))
        best = self._planned(found, progress)
        number = job_of(self.get_param_from_db, work.job).counted + 1
        values: dict[str, Any] = {"position_with_angle": 1.0, "x": best.x, "y": best.y, "z": best.z, "theta_w": THETA_W,
                  "depth": best.depth, "drag": best.drag, "number": number}  # fmt: skip
        if empty:
            values["fruitless"] = [float(value) for one in empty for value in one]
        self.set_param_in_db(model_name, DIG, values, create=True)

    def _planned(self, found: list[DigPoint], progress: Progress) -> DigPoint:
        """The first one that the planner would dig; what is like one that it has refused is left out."""
        refused: list[DigPoint] = []
        why: list[Reason] = []
        for one in found:
            if any(one.like(other) for other in refused):
                continue
            try:
                at = one.x, one.y, one.z
                self.machine.excavate(progress, at, THETA_W, 0.0, True, depth=one.depth, drag=one.drag)
            except SubtaskFailed as error:
                if not isinstance(error.reason, Aborted):
                    raise  # nobody has looked
                refused.append(one)
                why.append(error.reason)
            else:
                return one
            if len(refused) == TRIES:
                break
        raise SubtaskFailed(NoDigPlanned(len(refused), self.machine.name, why[0]))
