"""Decides whether the machine may move, and stops it: permit, latch, software stop, re-arm.

Stops begin on the executor thread, as goals are sent there: a goal either left before the stop, and is cancelled by
it, or does not leave any more.
"""

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from enum import Enum
from typing import Any

from tms_msg_rc.srv import Rearm, StopMachine

from tms_core.app import App
from tms_core.border import Controls
from tms_core.fence import Owner
from tms_core.permit import NOBODY, Link
from tms_core.ros import LOST_TEXT, Call, Goal, Peer
from tms_rc.chain import SCHEDULER, gap, members
from tms_rc.latch import ANY_LEAF, UNKNOWN_RUN, Latch
from tms_rc.memory import Memory
from tms_rc.permits import Permits
from tms_rc.standstill import StandStill
from tms_rc.stopper import STOP_LIMIT, Stop, Stopper

PERMIT_LIMIT = 3.0  # s that a goal may come before the permits behind it: a new process is discovered late on a busy PC
PRESSED = 1.0  # s that a software stop counts as pressed after its last message
FRESH = 1.0  # s, older news of the machine make it not ready
LEFT_MOVING = 2.0  # s that a new gateway looks for a motion that its predecessor left
RUN_TOLD = 3.0  # s for a new gateway to hear of the run whose machine it has stopped, before it latches


class Kind(Enum):
    """What a stop means for the next motion."""

    LATCH = "latched until re-armed"
    HOLD = "held for its run"
    PLAIN = "the end of a goal or of a run"


@dataclass
class Active:
    """The goal that moves the machine."""

    goal: Goal
    owner: Owner | None
    peer: Peer
    chain: dict[str, Owner]
    start: dict[str, float]  # rad, joints when it began
    call: Call | None = None
    stop: Stop | None = None
    changed: threading.Condition = field(default_factory=threading.Condition)

    def ended(self) -> bool:
        """Whether nothing of it can move the machine any more."""
        return self.call is None or self.call.outcome is not None

    def wake(self) -> None:
        with self.changed:
            self.changed.notify_all()


class Guard:
    """Of one machine."""

    def __init__(self, app: App, watch: StandStill, controls: Controls) -> None:
        self._app, self._watch, self._controls = app, watch, controls
        self._memory = Memory(app.site.state, app.machine)
        self.latch = Latch(self._memory.read())
        self.stopper = Stopper(app, controls, watch, self.silent, self._proof)
        self._news = threading.Condition()  # of permits
        self._taking = threading.Lock()
        self._run: int | None = None  # that holds the machine
        self._restarted = f"{LOST_TEXT}: {app.machine}:rc was restarted"
        self._unclaimed = True  # whether the last gateway may have left a motion of a run that is not known yet
        self._pressed = 0.0  # monotonic time of the last software stop message
        self.active: Active | None = None
        self.told: Callable[[], None] = lambda: None  # called when the latch has changed, to tell it at once
        self.permits = Permits(app, self._permit_changed)

    def silent(self) -> str | None:
        """What is not heard of the machine."""
        return self._watch.silent(time.monotonic(), FRESH)

    # who may move

    def take(self, active: Active) -> str | None:
        """Let a goal move the machine from now on; returns why it must not."""
        wrong = self._wait_for_permit(active.owner)
        if wrong is not None:
            return wrong
        with self._taking:
            if self.active is not None:
                return f"{self._app.machine} is still moved by another goal"
            wrong = self.latch.refusal(active.owner)
            if wrong is None:
                active.chain = members(active.owner, self.permits.held())
                self.active = active
        return wrong

    def last_look(self, active: Active) -> None:
        """Stop a goal that is about to leave if a stop or a loss came since it was let in. On the executor thread."""
        if active.stop is not None:
            return
        refusal, missing = self.latch.refusal(active.owner), gap(active.owner, self.permits.held())
        if refusal is not None:
            self.stop_now(refusal, Kind.PLAIN)
        elif missing is not None:
            lost = active.owner is not None and not missing.late
            self.stop_now(f"{LOST_TEXT}: {missing.text}" if lost else missing.text, Kind.HOLD if lost else Kind.PLAIN)

    def release(self) -> None:
        """The goal is over."""
        self.active = None

    def _wait_for_permit(self, owner: Owner | None) -> str | None:
        deadline = time.monotonic() + PERMIT_LIMIT
        with self._news:
            while True:
                if self.latch.cause:
                    return self.latch.refusal(owner)
                found, left = gap(owner, self.permits.held()), deadline - time.monotonic()
                if found is None:
                    return None
                if found.late or left <= 0:
                    return f"no motion permit: {found.text}"
                self._news.wait(min(left, 0.1))

    def _permit_changed(self, link: Link) -> None:
        if link.process == SCHEDULER:
            self._scheduler_changed(link)
        self.check_chain()
        with self._news:
            self._news.notify_all()

    def _scheduler_changed(self, link: Link) -> None:
        run = self.permits.held().get(SCHEDULER)
        if run is None and self._run is not None and link.goal != NOBODY:
            lost, self._run = self._run, None
            self.latch.run_lost()
            self.stop_now("tms:ts, the scheduler, was lost during a run", Kind.LATCH, run=lost)
            return
        self._run = None if run is None else run.run
        self.latch.run_is(self._run)
        if self._run is not None:
            self._take_over(self._run)

    def check_chain(self) -> None:
        """Stop when a process behind the present goal is gone."""
        active = self.active
        if active is None or active.stop is not None or active.owner is None:
            return
        held = self.permits.held()
        gone = [name for name, what in active.chain.items() if held.get(name) != what]
        if gone:
            names = ", ".join(f"{'tms' if name == SCHEDULER else self._app.machine}:{name}" for name in gone)
            self.stop_now(f"{LOST_TEXT}: {names} was lost during its goal", Kind.HOLD)

    # stop

    def stop_now(self, cause: str, kind: Kind, run: int = 0) -> Stop:
        """Stop whoever moves the machine. On the executor thread only; returns at once."""
        active = self.active
        if kind is Kind.LATCH:
            self.latch.close(cause)
        elif kind is Kind.HOLD and active is not None and active.owner is not None:
            self.latch.keep(cause, active.owner)
        ended = active.ended if active is not None else lambda: True
        run = run or (active.owner.run if active is not None and active.owner is not None else self._run or 0)
        stop = self.stopper.begin(cause, latched=kind is Kind.LATCH, run=run, ended=ended)
        if active is not None and active.call is not None:
            active.peer.cancel(active.call)  # also one that the machine has not answered yet
        if active is not None:
            active.stop = active.stop or stop
            active.wake()
        self.told()
        return stop

    def stop(self, cause: str, kind: Kind) -> Stop:
        """`stop_now` from any other thread; waits for the commands to have left, not for the machine."""
        begun: list[Stop] = []
        there = threading.Event()

        def step() -> None:
            begun.append(self.stop_now(cause, kind))
            there.set()

        self._app.ros.on_executor(step)
        if not there.wait(STOP_LIMIT):
            raise RuntimeError("the gateway's executor does not run any more")
        return begun[0]

    def signal(self, message: Any) -> None:
        """/emergency_signal: true stops and latches, as often as it is repeated; false does not arm anything."""
        now = time.monotonic()
        if not message.data:
            self._pressed = 0.0
            return
        fresh = now - self._pressed > PRESSED
        self._pressed = now
        if fresh or not self.latch.cause:
            self.stop_now("software stop", Kind.LATCH)

    def stop_service(self, request: StopMachine.Request, response: StopMachine.Response) -> StopMachine.Response:
        """Stop whoever moves the machine, foreign clients too; answers with what was seen."""
        stop = self.stop(request.cause or "software stop", Kind.PLAIN if request.orderly else Kind.LATCH)
        stop.over.wait(STOP_LIMIT + 1.0)
        response.receipt = stop.receipt
        return response

    def _proof(self, stop: Stop) -> None:
        """Called in the stop's own thread: at its begin, and when the machine was not seen to stand."""
        if stop.receipt is not None and not stop.receipt.confirmed:
            self.latch.close(f"{stop.cause}: not seen to stand ({stop.receipt.detail})")
            self._controls.emergency(True)
        self._remember()

    def _remember(self) -> None:
        try:
            self._memory.write(lambda: self.latch.cause)
        except OSError as error:  # the latch itself holds; it only would not outlive this process
            self._app.log.error("event=latch_not_kept reason=%r", str(error))

    # re-arm

    def rearm(self, request: Rearm.Request, response: Rearm.Response) -> Rearm.Response:
        """Two steps: without a token the cause and a token, with it the machine is armed."""
        response.cause = self.latch.cause or self.latch.hold
        code, text = self._keeps_from_arming(response.cause)
        now = time.monotonic()
        if not code and request.token:
            text = self.latch.confirm(request.token, now) or ""
            code = "BAD_TOKEN" if text else ""
            if not code:
                self._arm()
        elif not code:
            response.token = self.latch.request(now)
        response.armed = not self.latch.cause and not self.latch.hold
        response.error_code, response.error_msg = code, text
        return response

    def _arm(self) -> None:
        self._controls.emergency(False)
        self._remember()
        self._app.log.info("event=armed")
        self.told()

    def _keeps_from_arming(self, cause: str) -> tuple[str, str]:
        machine = self._app.machine
        if not cause:
            return "NOT_STOPPED", f"{machine} is armed: there is nothing to do"
        if self.active is not None:
            return "STILL_ACTIVE", f"{machine} still has an open goal: cancel its run first"
        if time.monotonic() - self._pressed < PRESSED:
            return "CAUSE_PERSISTS", "the software stop is still pressed: release it (false on /emergency_signal)"
        silent = self.silent()
        if silent is not None:
            return "CAUSE_PERSISTS", f"nobody sees whether {machine} stands: {silent}; is the machine on?"
        if not self._watch.standing(time.monotonic()):
            return "CAUSE_PERSISTS", f"{machine} does not stand still yet"
        return "", ""

    # start

    def recover(self) -> None:
        """After a start nobody knows what the last gateway left moving: cancel it, and stop a run's machine."""
        deadline = time.monotonic() + STOP_LIMIT
        while not self._controls.reachable() and time.monotonic() < deadline and not self._app.stopping.wait(0.02):
            pass
        self._controls.zero()
        self._controls.cancel_everything()
        if self.latch.cause:
            self._controls.emergency(True)
        deadline, stopped = time.monotonic() + LEFT_MOVING, False
        while self._unclaimed and self.active is None and time.monotonic() < deadline:
            if self._app.stopping.wait(0.02):
                return
            if not stopped and self.silent() is None and self._watch.moving():
                deadline, stopped = time.monotonic() + RUN_TOLD, True
                self._app.ros.on_executor(lambda: self._take_over(UNKNOWN_RUN))
        self._app.ros.on_executor(lambda: self._recovered(stopped))

    def _take_over(self, run: int) -> None:
        """Stop what the last gateway left moving for this run."""
        if not self._unclaimed or self.active is not None:
            return
        self._unclaimed = run == UNKNOWN_RUN
        self.latch.keep(self._restarted, Owner(run, ANY_LEAF))
        self.stop_now(self._restarted, Kind.PLAIN, run=0 if run == UNKNOWN_RUN else run)

    def _recovered(self, stopped: bool) -> None:
        """Whose motion was stopped is known by now, or it was nobody's."""
        if self._unclaimed and stopped and self.active is None:
            self.stop_now(f"{self._restarted} while it moved, and no run told of it", Kind.LATCH)
        self._unclaimed = False
