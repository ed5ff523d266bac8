"""Capability of every machine: a person is asked before it goes on."""

from tms_msg_ur.action import NextStepPermission

from tms_kit.acting import REQUEST, Acting, Progress
from tms_machine.reasons import Aborted, PersonSaysNo, WaitsForPerson
from tms_reason.errors import SubtaskFailed


class Permitting(Acting):
    """The permission of a person for the next step of a task."""

    def ask_person(self, progress: Progress, question: str) -> None:
        """Wait until a person says yes, in the console, the panel or by `tms answer`.

        Raises:
            SubtaskFailed: PersonSaysNo, or the scheduler is away.
        """
        progress(WaitsForPerson(question))
        goal = NextStepPermission.Goal(machinename=f"{self.name},{question}")
        try:
            self.act(NextStepPermission, REQUEST, goal)
        except SubtaskFailed as error:
            if isinstance(error.reason, Aborted):
                raise SubtaskFailed(PersonSaysNo(question)) from None
            raise
