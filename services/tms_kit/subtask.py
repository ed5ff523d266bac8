"""The interface for authors of subtasks: one function or one class, and the record as a model."""

import importlib
import inspect
from collections.abc import Callable, Mapping
from typing import Any, TypeVar, get_type_hints

from pydantic import BaseModel, ConfigDict

from tms_kit.machine import Machine, Progress, SubtaskCancelled
from tms_machine.goal_inputs import Inputs
from tms_machine.reasons import InputsNotTaken, OneSubtask
from tms_machine.values import Value
from tms_reason.errors import ConfigError, SubtaskFailed
from tms_reason.reason import Reason

__all__ = ["Machine", "Params", "Progress", "Subtask", "SubtaskCancelled", "SubtaskFailed", "load", "subtask"]


class Params(BaseModel):
    """A record as the subtask needs it. Further fields of the record are ignored, missing ones refuse the goal.

    An input of the goal (tms_machine.goal_inputs) counts instead of the record's field of that name.
    """

    model_config = ConfigDict(frozen=True, strict=True, allow_inf_nan=False, extra="ignore")

    def joint_angles(self) -> Mapping[str, float]:
        """Joint angles [rad] that the record asks for; the check before a run compares them with the limits."""
        return {}


class Subtask:
    """Class form, for subtasks that read records while they run.

    The runtime makes one instance per goal, calls `execute` in a worker thread, and at any end of it stops the motions
    that the machine still does. Returning is success.
    """

    timeout: float = 60.0  # s for the whole goal
    waits: bool = False  # for long, while nothing moves: such a goal ends when its scheduler is lost, as motions do
    params: type[Params] | None = None  # when given, the goal's record is checked before the goal is accepted

    def __init__(
        self,
        machine: Machine,
        want: Any,
        read: Callable[[str, str, float], dict[str, Value]],
        write: Callable[[str, str, Mapping[str, Value], bool], None],
    ) -> None:
        self.machine = machine
        self.want = want  # the checked record, None without `params`
        self._read, self._write = read, write

    def execute(self, model_name: str, record_name: str, progress: Progress) -> None:
        """Do the work of the subtask.

        Raises:
            SubtaskFailed: the machine cannot; the code and text reach the leaf node.
        """
        raise NotImplementedError

    @classmethod
    def not_taken(cls, inputs: Inputs) -> Reason | None:
        """Why a goal with these inputs is refused: an input that no field of `params` takes would be lost."""
        fields = cls.params.model_fields if cls.params is not None else {}
        lost = tuple(name for name in inputs if name not in fields)
        return InputsNotTaken(lost) if lost else None

    def on_cancel(self) -> None:
        """Called before the motion is stopped, twice if the cancel comes at the begin; must return at once."""

    def get_param_from_db(self, model_name: str, record_name: str, max_age: float = 0.0) -> dict[str, Value]:
        """The present record; may be called at any time, any number of times.

        `max_age`: age that a dynamic record may have [s]; 0: the record's own limit.

        Raises:
            SubtaskFailed: it is missing or too old, or the database does not answer.
        """
        return self._read(model_name, record_name, max_age)

    def set_param_in_db(
        self, model_name: str, record_name: str, values: Mapping[str, Value], create: bool = False
    ) -> None:
        """Set fields of a record, the others stay; with `create` a missing record is made.

        Raises:
            SubtaskFailed: it is missing, or static and used by this run, or the database does not answer.
        """
        self._write(model_name, record_name, values, create)


F = TypeVar("F", bound=Callable[..., None])


def subtask(timeout: float) -> Callable[[F], F]:
    """Mark `def name(machine: Machine, want: SomeParams, progress: Progress)` as a subtask."""

    def mark(function: F) -> F:
        wanted = list(get_type_hints(function).values())[1]
        if not (inspect.isclass(wanted) and issubclass(wanted, Params)):
            raise TypeError(f"{function.__name__}: the second argument needs a Params class as its type")

        class FromFunction(Subtask):
            def execute(self, model_name: str, record_name: str, progress: Progress) -> None:
                function(self.machine, self.want, progress)

        FromFunction.timeout, FromFunction.params = timeout, wanted
        function.__dict__["subtask"] = FromFunction
        return function

    return mark


def load(file: str) -> type[Subtask]:
    """The subtask in tms_subtasks/<file>.py: a Subtask class of its own, or the marked function.

    Raises:
        ConfigError: the file holds none or several.
    """
    module = importlib.import_module(f"tms_subtasks.{file}")
    own = [item for item in vars(module).values() if getattr(item, "__module__", "") == module.__name__]
    classes = [item for item in own if inspect.isclass(item) and issubclass(item, Subtask)]
    marked = [item.__dict__["subtask"] for item in own if inspect.isfunction(item) and "subtask" in item.__dict__]
    found = classes + marked
    if len(found) != 1:
        raise ConfigError(OneSubtask(f"tms_subtasks/{file}.py", len(found)))
    chosen: type[Subtask] = found[0]
    return chosen
