"""`tms:sp`: receives the declared sensing inputs and updates parameter records; does not wait for machines."""

from collections.abc import Callable
from typing import Any

from tms_msg_db.msg import RecordUpdate
from tms_msg_db.srv import UpdateParameters
from tms_msg_sp.msg import InputState, InputStates

from tms_config.clock import monotonic
from tms_config.yaml_file import located
from tms_machine.sensing import Input, load_sensing, sensing_path
from tms_machine.values import to_parameters
from tms_reason.errors import ConfigError
from tms_reason.reason import Reason
from tms_reason.validation import Wrong
from tms_reason.wire import refusal
from tms_runtime.app import App
from tms_sensors.message_types import message_class
from tms_sp.field_types import Fields
from tms_sp.inputs import SensingInput
from tms_sp.machine_states import MachineStateSampler
from tms_sp.mapping import Mapping
from tms_sp.outbox import InputUpdate, Outbox
from tms_sp.reasons import DatabaseAway, DatabaseSilent
from tms_sp.terrain import TerrainSensing

GAP = 0.015  # s between batches; the values that arrive in between are sent together
RETRY = 0.5  # s between attempts while the database or its store is away
ANSWER_LIMIT = 5.0  # s for the database to answer a batch
STATE_PERIOD = 1.0  # s between messages about the inputs
PUBLISHERS_CHECK_PERIOD = 0.5  # s between checks of which type is published on a topic that several inputs share


def start(app: App) -> None:
    """Subscribe to the inputs.

    Raises:
        ConfigError: sensing.yaml is wrong.
    """
    sensing = load_sensing(app.site)
    sender = Sender(app)
    inputs = [_input(app, name, given, sensing.clock_limit, sender) for name, given in sensing.inputs.items()]
    sender.inputs = {one.name: one for one in inputs}
    by_topic: dict[str, list[SensingInput]] = {}
    for one in inputs:
        by_topic.setdefault(one.given.topic, []).append(one)
    for topic, sharing in by_topic.items():
        TopicSubscription(app, topic, sharing)
    if sensing.machine_state.hz:
        MachineStateSampler(app, sensing.machine_state.hz)
    terrain = [TerrainSensing(app, name, given, sensing.clock_limit) for name, given in sensing.terrain.items()]
    publisher = app.ros.publisher(InputStates, "/tms/sp/inputs", depth=1, latched=True)

    def tell() -> None:
        told = [*(_state(app, one) for one in inputs), *(one.state() for one in terrain)]
        publisher.publish(InputStates(inputs=told))

    app.ros.every(STATE_PERIOD, tell)
    app.ready_when(sender.unready)


def fields_inside(kind: str) -> Fields:
    """Fields of the message that another one calls `package/Name`."""
    return message_class(kind.replace("/", "/msg/")).get_fields_and_field_types()


def _input(app: App, name: str, given: Input, clock_limit: float, sender: "Sender") -> SensingInput:
    try:
        fields = message_class(given.type).get_fields_and_field_types()
        return SensingInput(name, given, Mapping(given, fields, fields_inside), clock_limit, sender.put)
    except Wrong as error:
        raise ConfigError(located(sensing_path(app.site), error.reason, "inputs", name)) from error


def _state(app: App, one: SensingInput) -> InputState:
    state = one.state()
    if one.unlogged is not None:
        app.log.warning("refused", input=one.name, refused=one.refused, reason=one.unlogged)
        one.unlogged = None
    return state


class TopicSubscription:
    """The subscription of one topic. Of inputs that share it, the one whose type is published is received."""

    def __init__(self, app: App, topic: str, inputs: list[SensingInput]) -> None:
        self._ros, self._log, self._topic, self._inputs = app.ros, app.log, topic, inputs
        self._received: SensingInput | None = None
        self._subscription: Any = None
        if len(inputs) == 1:
            self._receive(inputs[0])
        else:
            app.ros.every(PUBLISHERS_CHECK_PERIOD, self._find_publisher)

    def _find_publisher(self) -> None:
        types = {info.topic_type for info in self._ros.node.get_publishers_info_by_topic(self._topic)}
        there = [one for one in self._inputs if one.given.type in types]
        if there and self._received not in there:
            self._receive(there[0])

    def _receive(self, one: SensingInput) -> None:
        if self._subscription is not None:
            self._ros.node.destroy_subscription(self._subscription)
        given, self._received = one.given, one
        self._subscription = self._ros.subscribe(
            message_class(given.type),
            given.topic,
            one.receive,
            given.depth,
            best_effort=given.reliability != "reliable",
        )
        self._log.info("listening", input=one.name, topic=given.topic, type=given.type)


class Sender:
    """Sends the outbox to the database: a batch at most every GAP; several may wait for their answers."""

    def __init__(self, app: App) -> None:
        self._ros, self._log = app.ros, app.log
        self.inputs: dict[str, SensingInput] = {}
        self._outbox = Outbox(lambda name: self.inputs[name].counts)
        self._flights: dict[int, float] = {}  # batch number -> time limit of its answer [s, monotonic]
        self._forget: dict[int, Callable[[], None]] = {}
        self._not_before = 0.0
        self._trouble: Reason | None = None
        self._clock = app.ros.every(GAP, self._send)  # cancelled while no values wait
        self._clock.cancel()
        self._retry = app.ros.every(RETRY, self._expire)  # cancelled while no values or answers are awaited

    def unready(self) -> Reason | None:
        """Why values do not reach the database."""
        if self._trouble is not None:
            return self._trouble
        there = self._ros.has_service(UpdateParameters, "/tms/db/update_parameters")
        return None if there else DatabaseAway()

    def put(self, update: InputUpdate) -> bool:
        """Take values to write; returns False when too many wait."""
        taken = self._outbox.put(update)
        if self._clock.is_canceled() and monotonic() >= self._not_before:
            self._clock.reset()
        if self._retry.is_canceled():
            self._retry.reset()
        return taken

    def _send(self) -> None:
        now = monotonic()
        if not self._outbox.ready or now < self._not_before:
            self._clock.cancel()
            return
        number, updates = self._outbox.take()
        request = UpdateParameters.Request(updates=[self._update(update, now) for update in updates])
        self._flights[number] = now + ANSWER_LIMIT
        forget = self._ros.call_then(
            UpdateParameters, "/tms/db/update_parameters", request, lambda answer: self._answered(number, answer)
        )
        if forget is None:
            self._fail(number, DatabaseAway())
        else:
            self._forget[number] = forget

    def _update(self, update: InputUpdate, now: float) -> RecordUpdate:
        one = self.inputs[update.source]
        return RecordUpdate(
            model_name=update.key[0], record_name=update.key[1], source=f"sp {update.source}",
            age=now - update.measured, loose=one.loose, keep=list(update.keep), values=to_parameters(update.values),
            expected=to_parameters(one.only_if),
        )  # fmt: skip

    def _answered(self, number: int, answer: UpdateParameters.Response) -> None:
        if number not in self._flights:
            return
        if answer.error_code:
            self._fail(number, refusal(answer.error_code, answer.error_msg))
            return
        del self._flights[number], self._forget[number]
        self._outbox.stored(number, [(one.index, one.code, refusal(one.code, one.text)) for one in answer.refused])
        if self._trouble is not None:
            self._log.info("database_back")
            self._trouble = None

    def _fail(self, number: int, why: Reason) -> None:
        """Keep the values of a failed batch and wait a moment."""
        self._flights.pop(number, None)
        forget = self._forget.pop(number, None)
        if forget is not None:
            forget()
        self._outbox.failed(number)
        self._not_before = monotonic() + RETRY
        if self._trouble is None:
            self._log.warning("database_away", reason=why)
        self._trouble = why

    def _expire(self) -> None:
        now = monotonic()
        for number, limit in list(self._flights.items()):
            if now > limit:
                self._fail(number, DatabaseSilent())
        if self._outbox.ready and now >= self._not_before:
            self._clock.reset()
        if not self._outbox.ready and not self._flights:
            self._retry.cancel()
