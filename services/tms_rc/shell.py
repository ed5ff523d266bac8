"""Runs the gateway's decisions: every event is a step, whose effects are done in their order, before the next event.

Steps are done one at a time, under a lock that is held for moments only: no step waits for anything. While a goal is
under way, beats run on the executor thread, where goals are sent: no goal leaves behind the back of a stop.
"""

import threading
from collections import deque
from collections.abc import Callable
from typing import Any, TypeVar

from tms_config.clock import monotonic, sleep
from tms_decision.gateway.effects import Effect, Log, Look
from tms_decision.gateway.events import Beat, Event
from tms_decision.gateway.state import Gateway
from tms_decision.gateway.step import step
from tms_runtime.app import App

PROOF_PERIOD = 0.05  # s between beats while a stop is being proven; states of machines come 10 to 50 times a second

E = TypeVar("E")
T = TypeVar("T")


class Shell:
    """The decisions of one machine's gateway, and who does their effects."""

    def __init__(self, app: App, gateway: Gateway) -> None:
        self._app, self._gateway = app, gateway
        self._lock = threading.RLock()
        self._coming: deque[Event] = deque()
        self._stepping = False
        self._proving = threading.Event()  # set while a stop waits for its proof
        self._doers: dict[type[Any], Callable[[Any], None]] = {}
        self.does(Log, self._log)
        self.does(Look, lambda _: app.ros.on_executor(self._beat))

    def does(self, kind: type[E], doer: Callable[[E], None]) -> None:
        """Have effects of a kind done by `doer`, which must not wait."""
        self._doers[kind] = doer

    def begin(self, effects: list[Effect], samples: Callable[[], list[Event]], look: Callable[[Gateway], Beat]) -> None:
        """Do the first effects, and beat from now on.

        `samples`: what the machine has told since the last beat; `look`: what is seen at a beat.
        """
        self._samples, self._look = samples, look
        with self._lock:
            self._do(effects)
        self._app.pulse.add(self._pulse)
        self._app.ros.loop.begin(self._prove, "stop")

    def happened(self, event: Event) -> None:
        """Let something happen; from any thread. On the executor thread it has happened when this returns."""
        self._app.ros.on_executor(lambda: self._take(event))

    def read(self, view: Callable[[Gateway, float], T]) -> T:
        """Look at the state between two steps."""
        with self._lock:
            return view(self._gateway, monotonic())

    def _take(self, event: Event) -> None:
        with self._lock:
            self._coming.append(event)
            if self._stepping:  # an effect made it happen
                return
            self._stepping = True
            while self._coming and not self._app.ros.closing:  # a successor stops the machine again
                self._do(step(self._gateway, self._coming.popleft(), monotonic()))
            self._stepping = False
            (self._proving.set if self._gateway.proves() else self._proving.clear)()

    def _do(self, effects: list[Effect]) -> None:
        for effect in effects:
            self._doers[type(effect)](effect)

    def _log(self, effect: Log) -> None:
        (self._app.log.warning if effect.warning else self._app.log.info)(effect.event, **effect.values)

    # beats

    def _pulse(self) -> None:
        """Beat here while no goal waits to be sent: to wake the executor thread costs ten times as much.

        Goals are sent by that thread only, so one that a beat sent here could leave after a stop that came meanwhile.
        """
        with self._lock:
            if not self._gateway.may_send():
                self._beat()
                return
        self._app.ros.on_executor(self._beat)

    def _beat(self) -> None:
        with self._lock:
            for event in self._samples():
                self._take(event)
            self._take(self._look(self._gateway))

    def _prove(self) -> None:
        """Beat faster while a stop is being proven: no goal can leave meanwhile, so this need not be the executor."""
        while not self._app.ros.closing:
            if self._proving.wait(1.0):
                sleep(PROOF_PERIOD)
                self._beat()
