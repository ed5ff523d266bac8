"""The state of the whole site, as the API shows it."""

from datetime import datetime

from pydantic import Field

from tms_ur.alarm_models import Alarm
from tms_ur.base_model import Model
from tms_ur.models import ActiveRun, Host, Machine, Question, Scheduler
from tms_ur.place_models import SharedPlaces
from tms_ur.watch_models import SeenBy


class State(Model):
    """Everything that goes on now."""

    time: datetime = Field(description="when this was put together, by the clock of this PC")
    machines: list[Machine]
    scheduler: Scheduler
    runs: list[ActiveRun] = Field(description="active runs")
    questions: list[Question] = Field(default=[])
    seen: list[SeenBy] = Field(default=[], description="what trackers of people, vehicles and gates tell")
    hosts: list[Host]
    shared: SharedPlaces = SharedPlaces()
    alarms: list[Alarm] = Field(
        default=[], description="by the rules of Prometheus, as far as tms:ur knows their facts; the critical first"
    )
