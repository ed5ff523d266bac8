"""Have the navigation compute a path to the goal of a record, and store it in another one; nothing moves."""

from pydantic import model_validator

from tms_kit.subtask import Params, Progress, Subtask
from tms_subtasks.records.places import PoseRecord, lists


class PathGoal(Params):
    """Where the path shall end, in `map`."""

    output: str  # an input of the variant: the record that the path is stored in; made if it is not there
    goal_x: float  # m
    goal_y: float  # m
    goal_qx: float
    goal_qy: float
    goal_qz: float = 0.0
    goal_qw: float

    @model_validator(mode="after")
    def _complete(self) -> "PathGoal":
        self.place()
        return self

    def place(self) -> PoseRecord:
        return PoseRecord(
            x=self.goal_x, y=self.goal_y, qx=self.goal_qx, qy=self.goal_qy, qz=self.goal_qz, qw=self.goal_qw
        )


class ComputePathToPose(Subtask):
    """The stored path is a record for follow_path, and for whatever else follows paths."""

    timeout = 60.0
    params = PathGoal

    def execute(self, model_name: str, record_name: str, progress: Progress) -> None:
        want: PathGoal = self.want
        path = self.machine.compute_path(progress, want.place().pose())
        self.set_param_in_db(model_name, want.output, lists(path), create=True)
