"""Models of the commands that clients send; those about records are in data_models.py."""

from typing import Any

from pydantic import ConfigDict, Field

from tms_reason.names import Name, Text
from tms_ur.base_model import Model
from tms_ur.models import INT32


class Command(Model):
    """Base of what clients send."""

    model_config = ConfigDict(strict=True)


class Login(Command):
    """Who wants a session."""

    name: Text = Field(max_length=64)
    password: str = Field(max_length=200)


class TaskGiven(Command):
    """A tree to store."""

    xml: str = Field(max_length=5 * 2**20)
    description: Text = Field(default="", max_length=1000)


class TemplateGiven(TaskGiven):
    """A tree to store as a template."""

    name: Name
    replace: bool = Field(default=False, description="also when a template of this name has another text")


class Xml(Command):
    """A tree to check or to compare."""

    xml: str = Field(max_length=5 * 2**20)


class StopAsked(Command):
    """Which machines to stop."""

    machine: str = Field(default="", pattern=r"^[a-z0-9_]{0,64}$", description="empty: all machines")


class RearmAsked(Command):
    """A step of a re-arm."""

    token: str = Field(default="", max_length=100, description="of the first step, empty in the first step")


class AreasGiven(Command):
    """Areas to check."""

    areas: dict[str, Any] = Field(description="GeoJSON with the frame `map`")


class AreasWanted(AreasGiven):
    """Areas to enable."""

    id: str = Field(max_length=64, description="of the set, as the check told it: it is enabled as it was shown")


class AnswerGiven(Command):
    """The answer to a question of a run."""

    yes: bool


class Nothing(Command):
    """An empty object."""


class StartRun(Command):
    """Which task to run."""

    task_id: int = Field(ge=1, le=INT32)
    ignore_warnings: bool = Field(default=False, description="start although the check before the run warns")
