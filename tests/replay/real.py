"""Carries a plan out on real processes."""

import signal
import threading
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from functools import partial
from time import sleep
from typing import Any

from std_msgs.msg import Bool
from test_stop import ask_to_move
from tms_msg_rc.srv import TakeMachine

from replay import acts as a
from replay.plans import ONE
from replay.real_runs import RealRuns
from replay.real_site import LIMIT, RealSite, full_name, send_signal
from replay.seen import Answer, Player, Seen
from tms_cli import session
from tms_cli.commands import rearm
from tms_config.clock import unix_time
from tms_reason import wire
from tms_reason.errors import TmsError
from tms_reason.reason import Foreign, Reason
from tms_ros.goals import Outcome

LOOK = 0.05  # s
PRESSES, PRESSED = 3, 0.3  # messages of a pressed button; s
PERSON = "Sato"


class Real:
    """One plan on a real site."""

    def __init__(self, plan: a.Plan, site: RealSite) -> None:
        self._plan, self._site, self._ros = plan, site, site.ros
        self._answers: list[Answer] = []
        self._frozen: list[int] = []
        self._pool = ThreadPoolExecutor(4, "replay")
        self._under_way: list[Future[None]] = []
        self._doers: dict[type[Any], Callable[[Any], None]] = {
            a.Start: lambda act: self._runs.start(act.run, site.task(act.leaves)),
            a.Cancel: lambda act: self._runs.cancel(act.run), a.Resume: lambda act: self._runs.resume(act.run),
            a.Press: lambda _: self._do(self._press), a.Rearm: self._rearm, a.AskToMove: self._ask,
            a.Take: partial(self._take, back=False), a.GiveBack: partial(self._take, back=True),
            a.Kill: self._kill, a.Freeze: self._freeze, a.Restart: self._restart,
            a.BeUnkind: lambda act: site.be(act.fault), a.StallDisk: self._stall,
        }  # fmt: skip

    def run(self) -> Seen:
        """Let it happen.

        Raises:
            Late: a moment of the plan does not come.
        """
        site = self._site
        site.put_in_order()
        site.write_records()
        self._runs, begun = RealRuns(self._ros), unix_time()
        try:
            self._play(begun)
        finally:
            self._thaw(self._frozen)
            site.be(None)
            self._pool.shutdown()
            self._runs.close()
        return self._seen(begun)

    def _play(self, begun: float) -> None:
        player = Player(self._plan, begun)
        while not player.over:
            act = player.due(self._seen(begun), unix_time())
            if act is not None:
                self._doers[type(act)](act)
            for one in [one for one in self._under_way if one.done()]:
                one.result()  # raises what it has raised
                self._under_way.remove(one)
            sleep(LOOK)

    def _seen(self, begun: float) -> Seen:
        return Seen({ONE: self._site.observer.since(begun)}, self._runs.entries, self._answers)

    def _do(self, step: Callable[[], None]) -> None:
        """Do what takes a while in a thread of its own."""
        self._under_way.append(self._pool.submit(step))

    # people

    def _press(self) -> None:
        for _ in range(PRESSES):
            self._site.button.publish(Bool(data=True))
            sleep(PRESSED / PRESSES)
        self._site.button.publish(Bool(data=False))

    def _rearm(self, act: a.Rearm) -> None:
        self._ask_for(act, lambda: rearm.ask(self._ros, ONE, rearm.ask(self._ros, ONE).token))

    def _take(self, act: a.Take | a.GiveBack, back: bool) -> None:
        service = f"/{ONE}/take"
        self._ask_for(act, lambda: session.call(self._ros, TakeMachine, service, seconds=LIMIT, who=PERSON, back=back))

    def _ask_for(self, act: a.Question, call: Callable[[], object]) -> None:
        def asked() -> None:
            wrong: Reason | None = None
            try:
                call()
            except TmsError as error:
                wrong = error.reason
            self._answers.append(Answer(type(act).__name__, wrong))

        self._do(asked)

    def _ask(self, act: a.AskToMove) -> None:
        def asked() -> None:
            call = ask_to_move(self._ros)
            why = wire.of(getattr(call.result, "error_string", "")) or Foreign(call.outcome.name)
            self._answers.append(Answer(type(act).__name__, None if call.outcome is Outcome.SUCCEEDED else why))

        self._do(asked)

    # faults

    def _kill(self, act: a.Kill) -> None:
        send_signal(signal.SIGKILL, self._site.pids(act.processes))
        if a.SCHEDULER in act.processes:
            self._runs.scheduler_lost()

    def _freeze(self, act: a.Freeze) -> None:
        pids = self._site.pids(act.processes)
        self._frozen += pids
        send_signal(signal.SIGSTOP, pids)
        timer = threading.Timer(act.seconds, self._thaw, (pids,))
        timer.daemon = True
        timer.start()

    def _thaw(self, pids: list[int]) -> None:
        send_signal(signal.SIGCONT, pids)
        self._frozen = [pid for pid in self._frozen if pid not in pids]

    def _restart(self, act: a.Restart) -> None:
        def restart() -> None:
            self._site.mesh.tms("restart", full_name(act.process))

        self._do(restart)

    def _stall(self, act: a.StallDisk) -> None:
        def stall() -> None:
            with self._site.stalled():
                sleep(act.seconds)  # the fault itself

        self._do(stall)
