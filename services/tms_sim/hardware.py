"""The hardware of a stand-in: it tells that the machine may move, unless a fault says otherwise."""

from typing import Any

from tms_config.site_file import Fault
from tms_hardware.settings import Signal, Source, hardware_of
from tms_runtime.app import App
from tms_sensors.message_types import message_class

PERIOD = 0.1  # s between messages; the alive counter counts them


class HardwareStandIn:
    """All sources of one machine."""

    def __init__(self, app: App, machine: str) -> None:
        self._sources = hardware_of(app.site, machine).sources
        self._kinds = {name: message_class(given.type) for name, given in self._sources.items()}
        self._publishers = {
            name: app.ros.publisher(self._kinds[name], f"/{machine}/{given.topic}")
            for name, given in self._sources.items()
        }
        self._count = 0

    def tell(self, fault: Fault) -> None:
        """Publish what each source says."""
        if "alive" not in fault.hardware:
            self._count = (self._count + 1) % 256  # what the smallest whole number of ROS holds
        for name, given in self._sources.items():
            if name not in fault.hardware_mute:
                self._publishers[name].publish(self._message(name, given, name in fault.hardware))

    def _message(self, name: str, given: Source, wrong: bool) -> Any:
        """A message of a source; `wrong`: it forbids motion."""
        message = at = self._kinds[name]()
        *path, field = given.field.split(".")
        for part in path:
            at = getattr(at, part)
        value = given.value(wrong != (name == "engine")) if isinstance(given, Signal) else self._count
        setattr(at, field, type(getattr(at, field))(value))
        return message
