"""Wait for a truck that is not full, choose where the bucket opens over it, and write it for release_simple."""

from tms_config.clock import sleep
from tms_control.links import Matrix
from tms_kit.reasons import NoPart, WaitsForTruck
from tms_kit.subtask import Progress, Subtask, SubtaskFailed
from tms_soil.dig_point import Stand
from tms_soil.dump_point import DumpPoint, dump_point, full
from tms_subtasks.records.digging_place import standing
from tms_subtasks.records.earthwork import DIG, DUMP, Earthwork, earthwork_of

LEVEL = 3.0  # rad, theta_w of a bucket that holds its soil
LOOKS = 0.5  # s between two looks at the trucks: one that stands in both has come to rest
STANDS = 0.05  # m that it may have moved meanwhile


class ChooseDumpPoint(Subtask):
    """Each part of the vessel in turn, by its load; the record tells which truck, and what was in the bucket."""

    timeout = 3600.0
    params = Earthwork

    def execute(self, model_name: str, record_name: str, progress: Progress) -> None:
        machine, check = self.machine, self.machine.check
        if machine.model.bucket is None:
            raise SubtaskFailed(NoPart(machine.name, "bucket"))
        while True:
            work = earthwork_of(self.get_param_from_db, model_name, record_name)
            stand = standing(machine, work.floor)
            for truck in work.trucks:
                if (at := self._place(truck, stand, work)) is not None:
                    load, own = machine.yard.load(truck, check), machine.yard.load(machine.name, check)
                    number = self.get_param_from_db(model_name, DIG)["number"]
                    values = {"position_with_angle": 1.0, "x": at.x, "y": at.y, "z": at.z, "theta_w": LEVEL,
                              "number": number, "truck": truck, "bank": own.bank, "before": load.bank}  # fmt: skip
                    self.set_param_in_db(model_name, DUMP, values)
                    return
            progress(WaitsForTruck(tuple(work.trucks)))
            check()

    def _place(self, truck: str, stand: Stand, work: Earthwork) -> DumpPoint | None:
        """Over a truck that stands in reach and has room."""
        machine, yard, check = self.machine, self.machine.yard, self.machine.check
        model, bucket = yard.model(truck), machine.model.bucket
        if model.vessel is None or bucket is None:
            raise SubtaskFailed(NoPart(truck, "vessel"))
        place = yard.link(truck, model.vessel.link, check)
        sleep(LOOKS)
        if _moved(place, yard.link(truck, model.vessel.link, check)):
            return None
        load, own = yard.load(truck, check), yard.load(machine.name, check)
        shape = model.shapes.get(model.vessel.link)
        edge = shape.max[2] if shape is not None else model.vessel.max[2]
        brings = max(own.loose, own.capacity / 2)  # an empty bucket may come here, too, when a run is resumed
        at = dump_point(model.vessel, place, edge, load.loose, bucket.width, brings, stand)
        in_reach = at.x**2 + at.y**2 <= work.far**2
        return at if in_reach and not full(model.vessel, load.loose) else None


def _moved(before: Matrix, now: Matrix) -> bool:
    return bool(abs(now[:3, 3] - before[:3, 3]).max() > STANDS)
