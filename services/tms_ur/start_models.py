"""Models of what a person is told before a run starts or goes on."""

from typing import Any

from pydantic import Field

from tms_ur.base_model import Model


class ResumePlan(Model):
    """What resuming an interrupted run would do first."""

    task_id: int
    done: list[str] = Field(description="leaves that are not repeated")
    next: list[str] = Field(description="leaves that were at work and begin again")


class BlackboardNow(Model):
    """What a node of an active run sees of what other nodes have written."""

    values: dict[str, Any] = Field(description="by key")


class TaskMachines(Model):
    """Which machines of the site a task moves."""

    machines: list[str]
