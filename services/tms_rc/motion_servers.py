"""Serves /<machine>/rc/<action> in front of the machine's own actions: goals become events, effects calls."""

import threading
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from itertools import count
from typing import TYPE_CHECKING, Any

from tms_decision.gateway.effects import Cancel, End, GiveUp, Lose, Send
from tms_decision.gateway.events import (
    CallAccepted,
    CallEnded,
    GoalAsked,
    GoalCancelled,
    Leaving,
)
from tms_decision.gateway.state import Gateway
from tms_decision.owner import parse
from tms_machine.border import MotionAction
from tms_machine.permit import RemotePermit
from tms_rc.goal_check import GoalCheck
from tms_rc.motion_goals import duration, reason_of, with_reason
from tms_rc.shell import Shell
from tms_reason.reason import Reason
from tms_ros.client import AnyCall, AnyPeer
from tms_ros.goals import Ended, Outcome
from tms_ros.server import AnyGoal
from tms_runtime.app import App

if TYPE_CHECKING:  # its libraries are loaded only where a site has areas
    from tms_rc.area_watch import AreaWatch
    from tms_rc.watches import Watch

CLOSING_CHECK_PERIOD = 1.0  # s
CANCELED = 0  # error code of a goal that its client has cancelled


@dataclass
class Served:
    """A goal of a client, and its call of the machine's own server."""

    number: int
    motion: MotionAction
    goal: AnyGoal
    peer: AnyPeer
    call: AnyCall | None = None
    end: End | None = None
    over: threading.Event = field(default_factory=threading.Event)


class MotionServers:
    """The motion actions of one machine."""

    def __init__(self, app: App, shell: Shell) -> None:
        self._app, self._shell = app, shell
        self._check = GoalCheck(app.site, app.machine)
        self._served: dict[int, Served] = {}
        self._numbers = count(1)
        self.peers: list[AnyPeer] = []
        self.areas: AreaWatch | None = None  # where the site has areas
        self.watches: list[Watch] = []  # what else may forbid motions
        ours = app.site.border(app.machine).controller == "ours"
        self._controller = RemotePermit(app.ros, app.pulse, app.machine, "mc", lambda _: None) if ours else None
        shell.does(Send, lambda effect: self._send(self._served[effect.number]))
        shell.does(End, self._end)
        for kind, act in ((Cancel, _cancel), (GiveUp, _give_up), (Lose, _lose)):
            shell.does(kind, self._with_call(act))

    def serve(self, motion: MotionAction, own: str) -> None:
        """Offer /<machine>/rc/<action> in front of the machine's own action `own`."""
        peer = self._app.ros.peer(motion.type, f"/{self._app.machine}/{own}")
        self.peers.append(peer)
        name = f"/{self._app.machine}/rc/{motion.served}"
        self._app.ros.serve(motion.type, name, lambda goal: self._run(motion, peer, goal))

    def goals(self) -> list[AnyGoal]:
        """The goals of clients that have not ended."""
        return [served.goal for served in list(self._served.values())]

    def look(self, gateway: Gateway) -> tuple[bool, bool, Reason | None]:
        """Whether the server of the active goal is there, or gone; and what has left its limits."""
        active = gateway.active
        served = self._served.get(active.number) if active is not None else None
        if active is None or served is None:
            return True, False, None
        gone = served.call is not None and served.call.accepted and self._lost(served.peer, served.call)
        escaped = self._check.escaped(gateway, active.start)
        if escaped is None and self.areas is not None:
            escaped = self.areas.astray(gateway)
        escaped = escaped or next(filter(None, (one.astray() for one in self.watches)), None)
        return served.peer.ready(), gone, escaped

    def _lost(self, peer: AnyPeer, call: AnyCall) -> bool:
        """Whether the server of a call is gone; our own controller says so seconds before discovery does."""
        return peer.left() or (self._controller is not None and self._controller.lost(call.id))

    def _run(self, motion: MotionAction, peer: AnyPeer, goal: AnyGoal) -> Ended[Any]:
        served = Served(next(self._numbers), motion, goal, peer)
        self._served[served.number] = served
        wrong = self._wrong(motion, goal.request)
        asked = GoalAsked(served.number, goal.id, parse(goal.uuid), peer.name, wrong)
        if wrong is None:
            asked = replace(asked, motion=self._check.motion(motion, goal.request), lasts=duration(goal.request))
        self._shell.happened(asked)
        goal.on_cancel = lambda: self._cancelled(served)
        if goal.cancelled.is_set():
            self._cancelled(served)
        while not served.over.wait(CLOSING_CHECK_PERIOD) and not self._app.ros.closing:
            pass
        del self._served[served.number]
        return _ended(served)

    def _wrong(self, motion: MotionAction, request: Any) -> Reason | None:
        """Why the machine must not do what a goal asks; its areas take longer than the shell's lock may be held."""
        wrong = self._shell.read(lambda gateway, _: self._check.problem(motion, request, gateway))
        wrong = wrong or self.forbidden(motion.drives)
        if wrong is not None or self.areas is None:
            return wrong
        return self.areas.problem(motion, request, self._shell.read(lambda gateway, _: gateway.watch.positions))

    def forbidden(self, drives: bool = True) -> Reason | None:
        """Why nothing may begin to move; `drives`: by its tracks."""
        return next(filter(None, (one.unready(drives) for one in self.watches)), None)

    def drives(self, number: int) -> bool:
        """Whether a goal moves the tracks; also for one that is gone meanwhile."""
        served = self._served.get(number)
        return served is None or served.motion.drives

    def _cancelled(self, served: Served) -> None:
        if self._app.stopping.is_set():
            self._shell.happened(Leaving())
        self._shell.happened(GoalCancelled(served.number))

    # effects

    def _send(self, served: Served) -> None:
        """Send the goal; its answers come on the executor thread, where this is called."""
        served.call = served.peer.send(
            served.goal.request, on_change=lambda call: self._changed(served, call), on_feedback=served.goal.publish
        )

    def _changed(self, served: Served, call: AnyCall) -> None:
        if call.outcome is not None:
            explained = bool(reason_of(call.result))
            self._shell.happened(CallEnded(served.number, call.outcome.name, explained))
        elif call.accepted:
            self._shell.happened(CallAccepted(served.number))

    def _with_call(self, act: Callable[[AnyPeer, AnyCall], None]) -> Callable[[Any], None]:
        def do(effect: Cancel | GiveUp | Lose) -> None:
            served = self._served.get(effect.number)
            if served is not None and served.call is not None:
                act(served.peer, served.call)

        return do

    def _end(self, effect: End) -> None:
        served = self._served[effect.number]
        served.end = effect
        served.over.set()


def _cancel(peer: AnyPeer, call: AnyCall) -> None:
    peer.cancel(call)


def _give_up(peer: AnyPeer, call: AnyCall) -> None:
    peer.resolve_unanswered(call)


def _lose(peer: AnyPeer, _call: AnyCall) -> None:
    peer.mark_lost()


def _ended(served: Served) -> Ended[Any]:
    end = served.end
    if end is None:  # the process closes before the stop was proven: its successor stops the machine again
        return Outcome.ABORTED, served.motion.type.Result()
    outcome = Outcome[end.outcome]
    if end.why is None:
        assert served.call is not None, "the machine's server has ended it"
        return outcome, served.call.result
    return outcome, with_reason(served.motion, end.why, CANCELED if outcome is Outcome.CANCELED else None)
