"""The errors that cross a border, one tree; each carries the reason why.

TmsError                 code and one line: what is wrong, where, what to do next
├── ConfigError          a file of configs/ is wrong: fix the file
├── TaskError            a task's XML is wrong: fix it in the editor
├── RosError             a peer did not answer or is not there: retry, see `tms ps`
├── DbError              the database refused or is away
└── SubtaskFailed        the machine cannot, or must not, do what was asked
"""

from tms_reason.reason import Foreign, Reason
from tms_reason.texts import sentence


class TmsError(Exception):
    """An error that a person reads: its reason for programs, and the reason's English text for the log."""

    code = "FAILED"

    def __init__(self, reason: Reason | str, code: str | None = None) -> None:
        super().__init__(sentence(reason, "en") if isinstance(reason, Reason) else reason)
        self.reason = reason if isinstance(reason, Reason) else Foreign(reason)
        if isinstance(reason, Reason):
            self.code = reason.code
        if code is not None:
            self.code = code


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
    """A subtask cannot do what its goal asks: `SubtaskFailed(reason)`.

    Still written `SubtaskFailed(code, message)` where a subtask has no reasons of its own yet.
    """

    def __init__(self, reason: Reason | str, message: str | None = None) -> None:
        if isinstance(reason, Reason):
            super().__init__(reason)
        else:
            super().__init__(message or "", reason)
            self.reason = Foreign(f"{reason}: {message or ''}")

    def __str__(self) -> str:
        return f"{self.code}: {self.args[0]}"
