"""Hears what the hardware of a machine tells."""

from collections.abc import Callable
from operator import attrgetter
from typing import Any

from tms_config.clock import monotonic
from tms_config.config import Site
from tms_config.yaml_file import located
from tms_hardware.hardware import Hardware
from tms_hardware.settings import Source, hardware_of
from tms_reason.errors import ConfigError
from tms_reason.validation import Wrong
from tms_ros.node import Ros
from tms_ros.topics import Arrival
from tms_sensors.message_types import message_class
from tms_sensors.reasons import NoFieldOf

DEPTH = 20  # messages of a source that may come between two looks


class HardwareHearing:
    """The hardware of one machine, for one thread."""

    def __init__(self, ros: Ros, site: Site, machine: str) -> None:
        """Listen to it.

        Raises:
            ConfigError: a type of message is not there, or has no such field.
        """
        settings = hardware_of(site, machine)
        self.hardware = Hardware(machine, settings, monotonic())
        self._inputs = {name: _input(ros, site, machine, name, one) for name, one in settings.sources.items()}

    def take(self) -> Hardware:
        """Take what has come since the last call."""
        for name, (take_new, value_of) in self._inputs.items():
            for arrival in take_new():
                self.hardware.heard(name, arrival.received, value_of(arrival.message))
        return self.hardware


def _input(
    ros: Ros, site: Site, machine: str, name: str, given: Source
) -> tuple[Callable[[], list[Arrival[Any]]], Callable[[Any], Any]]:
    value_of = attrgetter(given.field)
    try:
        kind = message_class(given.type)
        if not _has(kind(), value_of):
            raise Wrong(NoFieldOf(given.type, given.field))
    except Wrong as error:
        where = ("machines", machine, "hardware", name)
        raise ConfigError(located(site.path, error.reason, *where)) from error
    best_effort = given.reliability == "best_effort"
    return ros.sample_arrivals(kind, f"/{machine}/{given.topic}", DEPTH, best_effort=best_effort), value_of


def _has(message: Any, value_of: Callable[[Any], Any]) -> bool:
    try:
        value_of(message)
    except AttributeError:
        return False
    return True
