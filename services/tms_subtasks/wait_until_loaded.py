"""A truck stands until it is full, or the job is done; and until no bucket is over it."""

from tms_config.clock import sleep
from tms_kit.reasons import NoPart, WaitsForLoad
from tms_kit.subtask import Params, Progress, Subtask, SubtaskFailed
from tms_soil.dump_point import FULL, full
from tms_subtasks.records.earthwork import bucket_of, job_of

LOOKS = 0.3  # s


class Loading(Params):
    """Who loads it."""

    excavator: str  # machine
    job: str  # shared record that counts


class WaitUntilLoaded(Subtask):
    """A bucket over it is one that was chosen for it and is not counted yet."""

    timeout = 7200.0
    waits = True
    params = Loading

    def execute(self, model_name: str, record_name: str, progress: Progress) -> None:
        machine, vessel, read = self.machine, self.machine.model.vessel, self.get_param_from_db
        if vessel is None:
            raise SubtaskFailed(NoPart(machine.name, "vessel"))
        while True:
            load = machine.yard.loads([machine.name], machine.check)[0].loose
            job, bucket = job_of(read, self.want.job), bucket_of(read, self.want.excavator)
            below = bucket.truck == machine.name and bucket.number > job.counted
            if not below and (full(vessel, load) or job.done):
                return
            progress(WaitsForLoad(load, FULL * vessel.heaped))
            machine.check()
            sleep(LOOKS)
