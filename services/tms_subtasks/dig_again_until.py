"""Count the bucket that was emptied last, and tell whether the job is done: its volume is moved, or nothing is left."""

from tms_kit.reasons import Moved
from tms_kit.subtask import Progress, Subtask
from tms_subtasks.records.digging_place import left_to_dig
from tms_subtasks.records.earthwork import SHARED, Earthwork, bucket_of, counted, earthwork_of, fruitless, job_of


class DigAgainUntil(Subtask):
    """The job's record gets moved, counted and done in one step; a bucket that is counted counts no second time."""

    timeout = 60.0
    params = Earthwork

    def execute(self, model_name: str, record_name: str, progress: Progress) -> None:
        work = earthwork_of(self.get_param_from_db, model_name, record_name)
        job, bucket = job_of(self.get_param_from_db, work.job), bucket_of(self.get_param_from_db, model_name)
        own, *trucks = self.machine.yard.loads([self.machine.name, *work.trucks], self.machine.check)
        now = {name: one.bank for name, one in zip(work.trucks, trucks, strict=True)}.get(bucket.truck, 0.0)
        empty = [one.point for one in fruitless(self.get_param_from_db, model_name)]
        left = left_to_dig(self.machine, work, own.capacity, bucket.bearing, empty)
        found = counted(job, bucket, now, left=bool(left))
        self.set_param_in_db(SHARED, work.job, found.fields())
        progress(Moved(found.moved, job.volume, found.buckets))
