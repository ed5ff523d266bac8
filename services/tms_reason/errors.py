"""The errors that modules exchange, as one tree of classes; each carries its reason.

TmsError                 code and one line: what is wrong, where, what to do next
├── ConfigError          a file of configs/ is wrong: fix the file
├── TaskError            a task's XML is wrong: fix it in the editor
├── RosError             a peer did not answer or does not run: retry, see `tms ps`
├── DbError              the database refused or is away
└── SubtaskFailed        the machine cannot, or must not, do what was asked
"""

from tms_reason.reason import Foreign, Reason
from tms_reason.texts import sentence


class TmsError(Exception):
    """An error that people read: it has a reason for programs, and the reason's English text for the log."""

    code = "FAILED"

    def __init__(self, reason: Reason, code: str = "") -> None:
        """`code`: the code in a service's answer, where it differs from the reason's."""
        super().__init__(sentence(reason, "en"))
        self.reason = reason
        self.code = code or (type(self).code if isinstance(reason, Foreign) else reason.code)


class ConfigError(TmsError):
    """A configuration file is wrong; the message names the file and the key."""

    code = "BAD_CONFIG"


class TaskError(TmsError):
    """A task (behaviour tree) cannot be loaded; the message names the line."""

    code = "BAD_TASK"


class RosError(TmsError):
    """A ROS peer is missing or silent."""

    code = "NO_ANSWER"


class DbError(TmsError):
    """The database module refused a request or cannot reach its store."""

    code = "DB_FAILED"


class SubtaskFailed(TmsError):
    """A subtask cannot do what its goal asks; a text of its author is shown as it is, in every language."""

    def __init__(self, reason: Reason | str) -> None:
        super().__init__(Foreign(reason) if isinstance(reason, str) else reason)

    def __str__(self) -> str:
        return f"{self.code}: {self.args[0]}"
