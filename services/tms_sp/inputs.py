"""One sensing input: receives messages, refuses those that must not be written, and judges the state of the topic."""

import math
from collections import deque
from collections.abc import Callable

from prometheus_client import Counter, Gauge
from tms_msg_sp.msg import InputState

from tms_config.clock import monotonic, unix_time
from tms_machine.sensing import Input
from tms_reason.reason import Reason
from tms_reason.wire import to_line
from tms_ros.interface_types import Message
from tms_sp.clock import SourceClock
from tms_sp.mapping import Key, MappedValues, Mapping, MessageRefused
from tms_sp.outbox import Counts, InputUpdate
from tms_sp.reasons import ManyRecords, ManyWait, MeasuredEarlier, StampInFuture

MESSAGES = Counter("tms_sp_messages_total", "Messages by what became of them", ["input", "result"])
OFFSET = Gauge("tms_sp_clock_offset_seconds", "How far our clock is ahead of the source's", ["input"])
OFFSET_LIMIT = Gauge("tms_sp_clock_limit_seconds", "How far it may be ahead or behind")
AGE = Gauge("tms_sp_input_age_seconds", "Time since the last accepted message, or since the start", ["input"])
AGE_LIMIT = Gauge("tms_sp_input_age_limit_seconds", "Age at which an input with a declared rate is silent", ["input"])
SILENT_PERIODS = 10  # periods of the declared rate without a message
ARRIVALS = 50  # messages that the rate is measured over
MAX_RECORDS = 20
RECORDS_KNOWN = 5000  # records whose last stamps are kept


class SensingInput:
    """Used on the executor thread."""

    def __init__(
        self, name: str, given: Input, mapping: Mapping, clock_limit: float, put: Callable[[InputUpdate], bool]
    ):
        self.name, self.given, self.counts = name, given, Counts()
        self.loose, self.only_if = mapping.loose, given.only_if
        self._mapping, self._put, self._clock = mapping, put, SourceClock(clock_limit)
        self._clock_limit = clock_limit
        self._stamps: dict[Key, float] = {}
        self._taken: dict[Key, float] = {}
        self._arrivals: deque[float] = deque(maxlen=ARRIVALS)
        self._began = monotonic()
        AGE.labels(name).set_function(self._age_now)  # computed at the scrape, also while the executor is busy
        if given.hz:
            AGE_LIMIT.labels(name).set(SILENT_PERIODS / given.hz)
        OFFSET_LIMIT.set(clock_limit)
        self.accepted = self.refused = 0
        self.last_refusal: Reason | None = None
        self.unlogged: Reason | None = None  # a refusal that is not in the log yet

    def receive(self, message: Message) -> None:
        """Take one message."""
        try:
            result = self._take(message)
        except MessageRefused as refusal:
            self.refuse(refusal.code, refusal.reason)
            return
        MESSAGES.labels(self.name, result).inc()

    def refuse(self, code: str, why: Reason) -> None:
        """Count a refusal and keep it as the last one."""
        self.refused += 1
        self.last_refusal = self.unlogged = why
        MESSAGES.labels(self.name, code).inc()

    def _take(self, message: Message) -> str:
        reading = self._mapping.read(message)
        now, wall = monotonic(), unix_time()
        age = self._age(reading, wall)
        if self.given.max_hz and now - self._taken.get(reading.key, -math.inf) < 1.0 / self.given.max_hz:
            return "thinned"
        if len(self._stamps) > RECORDS_KNOWN and reading.key not in self._stamps:
            raise MessageRefused(ManyRecords(RECORDS_KNOWN, self.given.record))
        if not self._put(InputUpdate(self.name, reading.key, reading.values, now - age, reading.keep)):
            raise MessageRefused(ManyWait())
        self._taken[reading.key] = now
        self._stamps[reading.key] = reading.stamp if reading.stamp is not None else wall
        self._arrivals.append(now)
        self.accepted += 1
        return "accepted"

    def _age(self, reading: MappedValues, wall: float) -> float:
        """Seconds since the measurement.

        Raises:
            MessageRefused: StampInFuture, MeasuredEarlier.
        """
        if reading.stamp is None:
            return 0.0
        ahead = self._clock.ahead(reading.stamp, wall)
        if ahead > 0:
            raise MessageRefused(StampInFuture(ahead + self._clock_limit))
        before = self._stamps.get(reading.key)
        set_back = before is not None and self._clock.ahead(before, wall) > 0  # our clock was, after the stamp came
        if before is not None and reading.stamp < before and not set_back:
            raise MessageRefused(MeasuredEarlier(before - reading.stamp))
        return self._clock.age(reading.stamp, wall)

    def judge(self) -> str:
        """The state: waiting, alive, silent or clock."""
        last = self._arrivals[-1] if self._arrivals else None
        if last is None:
            return "waiting"
        if self.given.hz and monotonic() - last > SILENT_PERIODS / self.given.hz:
            return "silent"
        return "clock" if self._clock.off else "alive"

    def state(self) -> InputState:
        """The message for the topic of input states; updates the metrics, too."""
        now = monotonic()
        age = now - self._arrivals[-1] if self._arrivals else -1.0
        offset = self._clock.offset
        OFFSET.labels(self.name).set(math.nan if offset is None else offset)
        for code, why in self.counts.unwanted:
            self.refuse(code, why)
        self.counts.unwanted.clear()
        return InputState(
            name=self.name, topic=self.given.topic, type=self.given.type, hz_expected=self.given.hz, hz=self._rate(now),
            state=self.judge(), age=age, clock_offset=math.nan if offset is None else offset, accepted=self.accepted,
            written=self.counts.written, superseded=self.counts.superseded, refused=self.refused,
            last_refusal=to_line(self.last_refusal), records=[f"{model}/{record}" for model, record in self._records()],
        )  # fmt: skip

    def _age_now(self) -> float:
        return monotonic() - (self._arrivals[-1] if self._arrivals else self._began)

    def _records(self) -> list[Key]:
        return sorted(self._taken)[:MAX_RECORDS]

    def _rate(self, now: float) -> float:
        """Messages a second, from the first of the last ARRIVALS until now."""
        if len(self._arrivals) < 2:
            return 0.0
        return (len(self._arrivals) - 1) / max(now - self._arrivals[0], 1e-3)
