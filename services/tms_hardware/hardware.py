"""The state of a machine's hardware, by what it has told last and how old that is."""

import math
from dataclasses import dataclass
from typing import Literal

from tms_hardware.reasons import (
    CounterFrozen,
    EmergencyStopPressed,
    EngineOff,
    LeverLocked,
    SignalSilent,
    SignalUnheard,
    SignalUnreadable,
    SwitchedToManual,
)
from tms_hardware.settings import Counter, HardwareSettings, Signal, Source, Value
from tms_reason.reason import Reason

Known = Literal["yes", "no", "unknown"]
FORBIDS = {"emergency_stop": EmergencyStopPressed, "lock_lever": LeverLocked, "manual": SwitchedToManual}  # with a yes


@dataclass(frozen=True)
class Condition:
    """What follows from the hardware now."""

    stop: Reason | None = None  # and latch
    hold: Reason | None = None  # until it is over, or for good where it is a loss
    lost: Reason | None = None  # nobody knows the state of the machine

    @property
    def wrong(self) -> Reason | None:
        """Why nothing may begin to move, and no person may arm the machine."""
        return self.stop or self.hold or self.lost


@dataclass
class Told:
    """What one source has told. Times are of one monotonic clock [s]."""

    given: Source
    at: float  # when somebody began to listen, or when the last message came; of a counter, when it changed last
    value: Value | None = None  # None: nothing yet, or what cannot be read
    unreadable: bool = False


class Hardware:
    """The hardware of one machine. Not for several threads."""

    def __init__(self, machine: str, settings: HardwareSettings, now: float) -> None:
        self._machine = machine
        self._told = {name: Told(given, now) for name, given in settings.sources.items()}

    def heard(self, source: str, at: float, value: object) -> None:
        """Take the value of a source's field; anything but a finite number, a text or a truth cannot be read."""
        one = self._told[source]
        if not isinstance(value, (bool, int, float, str)) or (isinstance(value, float) and not math.isfinite(value)):
            one.unreadable, one.value = True, None
            return
        if not isinstance(one.given, Counter) or one.value is None or value != one.value:
            one.at = at
        one.unreadable, one.value = False, value

    def says(self, source: str, now: float) -> Known:
        """What a source says; of the alive counter, whether it counts."""
        one = self._told[source]
        if one.value is None or now - one.at > one.given.silent_after:
            return "unknown" if isinstance(one.given, Signal) else "no"
        return "yes" if not isinstance(one.given, Signal) or one.given.says_yes(one.value) else "no"

    def state(self, now: float) -> dict[str, Known]:
        """What each source says."""
        return {name: self.says(name, now) for name in self._told}

    def look(self, now: float) -> Condition:
        """What follows for the machine."""
        stop = hold = lost = None
        for name, one in self._told.items():
            lost = lost or self._loss(name, one, now)
            if not isinstance(one.given, Signal) or (why := self._forbids(name, self.says(name, now))) is None:
                continue
            if one.given.then == "latch":
                stop = stop or why
            else:
                hold = hold or why
        return Condition(stop, hold, lost)

    def _forbids(self, name: str, says: Known) -> Reason | None:
        if name == "engine":
            return EngineOff(self._machine) if says == "no" else None
        return FORBIDS[name](self._machine) if says == "yes" else None

    def _loss(self, name: str, one: Told, now: float) -> Reason | None:
        age = now - one.at
        if one.unreadable:
            return SignalUnreadable(self._machine, name)
        if one.value is None:
            return SignalUnheard(self._machine, name)
        if age <= one.given.silent_after:
            return None
        return CounterFrozen(self._machine, age) if name == "alive" else SignalSilent(self._machine, name, age)
