"""What calls a person, as the API shows it."""

from datetime import datetime
from typing import Literal

from pydantic import Field

from tms_ur.base_model import Model
from tms_ur.reason_view import ReasonView

Severity = Literal["critical", "warning"]


class Alarm(Model):
    """A rule of deploy/prometheus/rules.yml that holds for something now, and has held for as long as it must."""

    name: str = Field(description="of the rule, as Prometheus has it")
    severity: Severity = Field(description="critical: look now; warning: look today")
    subject: str = Field(description="the machine, process, PC or sensing input that it is about")
    reason: ReasonView
    since: datetime = Field(description="since when this console has seen it")
