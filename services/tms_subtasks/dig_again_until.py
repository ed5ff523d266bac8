"""Count the bucket that was emptied last, and tell whether the job is done: its volume is moved, or nothing is left."""

from tms_kit.reasons import Moved
from tms_kit.subtask import Progress, Subtask
from tms_subtasks.records.digging_place import left_to_dig
from tms_subtasks.records.earthwork import SHARED, Earthwork, bucket_of, counted, earthwork_of, job_of


class DigAgainUntil(Subtask):
    """The job's record gets moved, counted and done in one step; a bucket that is counted counts no second time."""

    timeout = 60.0
    params = Earthwork

    def execute(self, model_name: str, record_name: str, progress: Progress) -> None:
        work = earthwork_of(self.get_param_from_db, model_name, record_name)
        job, bucket = job_of(self.get_param_from_db, work.job), bucket_of(self.get_param_from_db, model_name)
        now = self.machine.yard.load(bucket.truck, self.machine.check).bank if bucket.truck else 0.0
        found = counted(job, bucket, now, left=bool(left_to_dig(self.machine, work, 0.0)))
        self.set_param_in_db(SHARED, work.job, found.fields())
        progress(Moved(found.moved, job.volume, found.buckets))
