"""Wait for a truck that is not full, choose where the bucket opens over it, and write it for release_simple."""

from tms_msg_ground.msg import SoilLoad

from tms_control.links import Matrix
from tms_kit.reasons import NoPart, WaitsForTruck
from tms_kit.subtask import Progress, Subtask, SubtaskFailed
from tms_soil.dig_point import Stand
from tms_soil.dump_point import DumpPoint, dump_point, full
from tms_subtasks.records.digging_place import standing
from tms_subtasks.records.earthwork import DIG, DUMP, Earthwork, earthwork_of

LEVEL = 3.0  # rad, theta_w of a bucket that holds its soil
STANDS = 0.02  # m that a truck may move while all tell their loads, about 0.2 s: one that moves less has come to rest


class ChooseDumpPoint(Subtask):
    """Each part of the vessel in turn, by its load; the record tells which truck, and what was in the bucket."""

    timeout = 3600.0
    waits = True
    params = Earthwork

    def execute(self, model_name: str, record_name: str, progress: Progress) -> None:
        machine, check = self.machine, self.machine.check
        if machine.model.bucket is None:
            raise SubtaskFailed(NoPart(machine.name, "bucket"))
        while True:
            work = earthwork_of(self.get_param_from_db, model_name, record_name)
            stand = standing(machine, work.floor)
            before = {truck: self._vessel(truck) for truck in work.trucks}
            own, *loads = machine.yard.loads([machine.name, *work.trucks], check)
            for truck, load in zip(work.trucks, loads, strict=True):
                stood = not _moved(before[truck], self._vessel(truck))
                if stood and (at := self._over(truck, before[truck], load, own, stand, work)) is not None:
                    number = self.get_param_from_db(model_name, DIG)["number"]
                    values = {"position_with_angle": 1.0, "x": at.x, "y": at.y, "z": at.z, "theta_w": LEVEL,
                              "number": number, "truck": truck, "bank": own.bank, "before": load.bank}  # fmt: skip
                    self.set_param_in_db(model_name, DUMP, values)
                    return
            progress(WaitsForTruck(tuple(work.trucks)))
            check()

    def _vessel(self, truck: str) -> Matrix:
        """Where its vessel is in map."""
        vessel = self.machine.yard.model(truck).vessel
        if vessel is None:
            raise SubtaskFailed(NoPart(truck, "vessel"))
        return self.machine.yard.link(truck, vessel.link, self.machine.check)

    def _over(
        self, truck: str, place: Matrix, load: SoilLoad, own: SoilLoad, stand: Stand, work: Earthwork
    ) -> DumpPoint | None:
        """Over a truck in reach that has room."""
        model, bucket = self.machine.yard.model(truck), self.machine.model.bucket
        assert model.vessel is not None and bucket is not None
        shape = model.shapes.get(model.vessel.link)
        edge = shape.max[2] if shape is not None else model.vessel.max[2]
        brings = max(own.loose, own.capacity / 2)  # an empty bucket may come here, too, when a run is resumed
        at = dump_point(model.vessel, place, edge, load.loose, bucket.width, brings, stand)
        in_reach = at.x**2 + at.y**2 <= work.far**2
        return at if in_reach and not full(model.vessel, load.loose) else None


def _moved(before: Matrix, now: Matrix) -> bool:
    return bool(abs(now[:3, 3] - before[:3, 3]).max() > STANDS)
