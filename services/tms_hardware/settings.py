"""Model of `hardware:` of a machine in the site file: which topics tell the state of its hardware."""

from typing import Any, Literal

from pydantic import Field, ValidationError

from tms_config.config import Site
from tms_config.models import Settings
from tms_config.yaml_file import located
from tms_reason.errors import ConfigError
from tms_reason.validation import problems

Value = bool | int | float | str
Then = Literal["latch", "hold"]


class Source(Settings):
    """One field of the messages of a topic."""

    topic: str = Field(pattern=r"^[A-Za-z][A-Za-z0-9_/]*$")  # below the machine's name
    type: str = Field(pattern=r"^[a-z][a-z0-9_]*/msg/[A-Z][A-Za-z0-9]*$", default="std_msgs/msg/Bool")
    field: str = Field(pattern=r"^[a-z]\w*(\.[a-z]\w*)*$", default="data")  # path through sub-messages
    reliability: Literal["reliable", "best_effort"] = "reliable"
    silent_after: float = Field(gt=0, le=60, default=1.0)  # s without a message after which nobody knows


class Signal(Source):
    """A source that says yes or no."""

    when: Value = True  # the value that means yes ...
    above: float | None = None  # ... or the number above which it does
    then: Then = "hold"  # what it means if it forbids motion: latched, or held until it is over

    def says_yes(self, value: Value) -> bool:
        """Whether a value means yes."""
        return value == self.when if self.above is None else isinstance(value, (int, float)) and value > self.above

    def value(self, yes: bool) -> Value:
        """A value that means yes, or no."""
        if self.above is not None:
            return self.above + (1.0 if yes else -1.0)
        if yes or isinstance(self.when, bool):
            return self.when if yes else not self.when
        return "" if isinstance(self.when, str) else self.when + 1


class PressedStop(Signal):
    """A stop is pressed by a person, so only a person may let the machine go on."""

    then: Then = "latch"


class Counter(Source):
    """A number that changes while the machine's own computer works; `silent_after` without a change is a loss."""

    type: str = Field(pattern=r"^[a-z][a-z0-9_]*/msg/[A-Z][A-Za-z0-9]*$", default="std_msgs/msg/UInt32")


class HardwareSettings(Settings):
    """What the hardware of a machine tells; what is absent is not known, and forbids nothing."""

    emergency_stop: PressedStop | None = None  # yes: the relay of its emergency stop is open
    lock_lever: Signal | None = None  # yes: the lever locks the hydraulics
    manual: Signal | None = None  # yes: its switch stands on manual, not on remote or automatic
    engine: Signal | None = None  # yes: the engine runs
    alive: Counter | None = None

    @property
    def sources(self) -> dict[str, Source]:
        """By name, those that it has."""
        return {name: one for name in type(self).model_fields if (one := getattr(self, name)) is not None}


def hardware_of(site: Site, machine: str) -> HardwareSettings:
    """The hardware of a machine.

    Raises:
        ConfigError: names the file and the key.
    """
    given: dict[str, Any] = site.file.machines[machine].hardware
    try:
        return HardwareSettings.model_validate(given)
    except ValidationError as error:
        keys, reason = next(problems(error))
        raise ConfigError(located(site.path, reason, "machines", machine, "hardware", *keys)) from error
