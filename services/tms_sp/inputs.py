"""One sensing input: receives messages, refuses those that must not be written, and judges the state of the topic."""

import math
from collections.abc import Callable

from prometheus_client import Counter, Gauge
from tms_msg_sp.msg import InputState

from tms_config.clock import monotonic, unix_time
from tms_interfaces.generated import Message
from tms_machine.sensing import Input
from tms_reason.reason import Reason
from tms_reason.wire import to_line
from tms_sp.arrivals import SILENT_PERIODS, Arrivals
from tms_sp.clock import SourceClock
from tms_sp.mapping import Key, MappedValues, Mapping, MessageRefused
from tms_sp.outbox import Counts, InputUpdate
from tms_sp.reasons import ManyRecords, ManyWait

MESSAGES = Counter("tms_sp_messages_total", "Messages by what became of them", ["input", "result"])
OFFSET = Gauge("tms_sp_clock_offset_seconds", "How far our clock is ahead of the source's", ["input"])
OFFSET_LIMIT = Gauge("tms_sp_clock_limit_seconds", "How far it may be ahead or behind")
AGE = Gauge("tms_sp_input_age_seconds", "Time since the last accepted message, or since the start", ["input"])
AGE_LIMIT = Gauge("tms_sp_input_age_limit_seconds", "Age at which an input with a declared rate is silent", ["input"])
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
        self._stamps: dict[Key, float] = {}
        self._taken: dict[Key, float] = {}
        self._arrivals = Arrivals(given.hz)
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
        self._arrivals.add(now)
        self.accepted += 1
        return "accepted"

    def _age(self, reading: MappedValues, wall: float) -> float:
        """Seconds since the measurement.

        Raises:
            MessageRefused: StampInFuture, MeasuredEarlier.
        """
        if reading.stamp is None:
            return 0.0
        self._clock.check(reading.stamp, self._stamps.get(reading.key), wall)
        return self._clock.age(reading.stamp, wall)

    def judge(self) -> str:
        """The state: waiting, alive, silent or clock."""
        return self._arrivals.state(monotonic(), self._clock.off)

    def state(self) -> InputState:
        """The message for the topic of input states; updates the metrics, too."""
        now = monotonic()
        offset = self._clock.offset
        OFFSET.labels(self.name).set(math.nan if offset is None else offset)
        for code, why in self.counts.unwanted:
            self.refuse(code, why)
        self.counts.unwanted.clear()
        return InputState(
            name=self.name, topic=self.given.topic, type=self.given.type, hz_expected=self.given.hz,
            hz=self._arrivals.rate(now), state=self.judge(), age=self._arrivals.age(now),
            clock_offset=math.nan if offset is None else offset, accepted=self.accepted,
            written=self.counts.written, superseded=self.counts.superseded, refused=self.refused,
            last_refusal=to_line(self.last_refusal), records=[f"{model}/{record}" for model, record in self._records()],
        )  # fmt: skip

    def _age_now(self) -> float:
        last = self._arrivals.last
        return monotonic() - (self._began if last is None else last)

    def _records(self) -> list[Key]:
        return sorted(self._taken)[:MAX_RECORDS]
