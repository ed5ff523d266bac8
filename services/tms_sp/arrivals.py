"""When the messages of an input came: how often, how long ago, and what that means."""

from collections import deque

ARRIVALS = 50  # messages that the rate is measured over
SILENT_PERIODS = 10  # periods of the declared rate without a message


class Arrivals:
    """Of one input; times are monotonic [s]."""

    def __init__(self, hz: float) -> None:
        """`hz`: the declared rate; 0: none is."""
        self._hz = hz
        self._times: deque[float] = deque(maxlen=ARRIVALS)

    def add(self, now: float) -> None:
        """Note a message that was accepted."""
        self._times.append(now)

    @property
    def last(self) -> float | None:
        """When the last one came; None: none has."""
        return self._times[-1] if self._times else None

    def age(self, now: float) -> float:
        """Seconds since the last one; -1: none has come."""
        return -1.0 if self.last is None else now - self.last

    def rate(self, now: float) -> float:
        """Messages a second, from the first of the last ARRIVALS until now."""
        if len(self._times) < 2:
            return 0.0
        return (len(self._times) - 1) / max(now - self._times[0], 1e-3)

    def state(self, now: float, clock_off: bool) -> str:
        """The state of the input: waiting, alive, silent or clock."""
        if self.last is None:
            return "waiting"
        if self._hz and now - self.last > SILENT_PERIODS / self._hz:
            return "silent"
        return "clock" if clock_off else "alive"
