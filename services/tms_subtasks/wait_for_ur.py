"""Ask a person whether the machine may go on; the record's name is the question, and nothing is read of it."""

from tms_kit.machine import Progress
from tms_kit.subtask import Subtask

DAY = 86_400.0  # s


class WaitForUr(Subtask):
    """Yes succeeds, No fails; a Timeout above the leaf, or a cancel, ends the question."""

    timeout = DAY
    waits = True

    def execute(self, model_name: str, record_name: str, progress: Progress) -> None:
        self.machine.ask_person(progress, record_name)
