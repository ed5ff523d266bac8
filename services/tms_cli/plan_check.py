"""Finds the subtask that a record is for, and has the planner check what it would do."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from pydantic import ValidationError
from tms_msg_db.srv import GetParameter
from tms_msg_rp.srv import CheckMotion

from tms_cli import session
from tms_cli.reasons import ForNoArm, RecordUnfitFor, WhichSubtask
from tms_config.config import Site
from tms_config.models import MachineModel
from tms_config.reasons import NoPlannedArm
from tms_kit.rehearsal import NotOfArm, Refused, Rehearsal, service_of
from tms_machine.values import from_parameters
from tms_reason.errors import ConfigError, SubtaskFailed, TmsError
from tms_reason.reason import Reason
from tms_reason.validation import explain

if TYPE_CHECKING:
    from tms_ros.node import Ros

WHATEVER_AGE = -1.0


@dataclass(frozen=True)
class Checked:
    """What the planner has answered to a subtask, and why it would refuse; `lasting`: see CheckMotion."""

    subtask: str
    answers: tuple[CheckMotion.Response, ...]
    refusal: Reason | None = None
    lasting: bool = False


def check(node: "Ros", site: Site, machine: str, record: str, subtask: str) -> Checked:
    """Check a record of a machine; `subtask`: empty for the one that the record is for.

    Raises:
        TmsError: the machine has no planner, no subtask (or several) fit, there is no such record, nobody answers.
    """
    model = site.model_of(machine)
    if model.planner is None:
        raise ConfigError(NoPlannedArm(machine))
    if subtask and subtask not in model.subtasks:
        raise ConfigError(WhichSubtask(record, tuple(model.subtasks)))
    stored: dict[tuple[str, str], Mapping[str, Any]] = {}

    def read(of: str, name: str) -> Mapping[str, Any]:
        if (of, name) not in stored:
            answer = session.call(node, GetParameter, "/tms/db/get_parameter", model_name=of, record_name=name,
                                  max_age=WHATEVER_AGE)  # fmt: skip
            stored[of, name] = from_parameters(answer.record.values)
        return stored[of, name]

    def ask(request: CheckMotion.Request) -> CheckMotion.Response:
        return node.call(CheckMotion, service_of(machine), request, session.CALL_LIMIT)

    read(machine, record)
    found, unfit = list[Checked](), dict[str, Reason]()
    for name in [subtask] if subtask else _candidates(model, record):
        rehearsal = Rehearsal(node, machine, site.file.machines[machine].model, model, ask)
        try:
            rehearsal.rehearse(name, record, {}, read)
            found.append(Checked(name, tuple(rehearsal.answers)))
        except Refused as error:
            found.append(Checked(name, tuple(rehearsal.answers), error.reason, error.lasting))
        except ValidationError as error:
            unfit[name] = explain(error)
        except SubtaskFailed as error:
            unfit[name] = error.reason
        except NotOfArm:
            continue
    return _only(found, unfit, record)


def _only(found: list[Checked], unfit: Mapping[str, Reason], record: str) -> Checked:
    if len(found) == 1:
        return found[0]
    if found:
        raise TmsError(WhichSubtask(record, tuple(one.subtask for one in found)))
    if len(unfit) == 1:
        ((name, why),) = unfit.items()
        raise TmsError(RecordUnfitFor(record, name, why))
    raise TmsError(ForNoArm(record))


def _candidates(model: MachineModel, record: str) -> Iterable[str]:
    """The subtasks that the machine file shows with this record, else all; of those that run the same, the first."""
    shown = [name for name in model.subtasks if model.subtask(name).example == record]
    first: dict[str, str] = {}
    for name in shown or list(model.subtasks):
        first.setdefault(model.subtask(name).run, name)
    return first.values()
