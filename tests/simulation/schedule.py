"""A schedule: a site in which things go wrong by a plan; invariants are looked at all the time."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from simulation import plan as p
from simulation.plan import SECONDS, Planned
from simulation.plant import Fault
from simulation.site import STOP_IN_TIME, Process, Site
from simulation.world import Happened, Violation, World
from tms_decision.gateway import effects as f
from tms_decision.gateway import events as e

LOOK = 0.1  # s between looks at the invariants
ANSWERED = 12.0  # s in which every call is answered
LEVERS = 0.2  # rad/s of a person at the levers


@dataclass
class Result:
    """How a schedule went."""

    seed: int
    plan: Sequence[Planned]
    events: int
    goals: int  # that were sent to the machine
    violation: str
    history: list[Happened]


class Schedule:
    """One seed, with its plan or a shorter one."""

    def __init__(self, seed: int, plan: Sequence[Planned] | None = None) -> None:
        self.seed, self.plan = seed, p.plan(seed) if plan is None else plan
        self.world = World(seed)
        self.site = Site(self.world, at_once=seed % 2 == 0)
        self._doers: dict[type[Any], Callable[[Any], None]] = {
            p.Kill: self._kill, p.Freeze: self._freeze, p.Lie: self._lie, p.Stall: self._stall, p.Press: self._press,
            p.Rearm: lambda _: self.site.rearm(), p.Take: self._take, p.Stranger: self._stranger,
            p.ForeignGoal: self._foreign,
        }  # fmt: skip

    def run(self) -> Result:
        """Let it happen."""
        world, site, violation = self.world, self.site, ""
        try:
            site.start()
            for one in self.plan:
                world.at(one.at, lambda one=one: self._doers[type(one.act)](one.act))  # type: ignore[misc]
            world.after(LOOK, self._look)
            world.run(SECONDS)
        except Violation as found:
            violation = str(found)
            world.tell("VIOLATION", violation)
        return Result(self.seed, self.plan, world.events, site.goals_sent, violation, world.history)

    # what goes wrong

    def _process(self, name: str) -> Process:
        site = self.site
        return {"rc": site.gateway, "ts": site.scheduler, "subtask": site.subtask, "host": site.host}[name]

    def _kill(self, act: p.Kill) -> None:
        for name, again in zip(act.processes, act.again, strict=True):
            process = self._process(name)
            if process.alive:
                process.kill()
                self.world.after(again, getattr(process, "start", process.begin))

    def _freeze(self, act: p.Freeze) -> None:
        for name in act.processes:
            self._process(name).freeze(act.seconds)

    def _lie(self, act: p.Lie) -> None:
        self.site.fault(act.fault)
        self.world.after(act.seconds, lambda: self.site.fault(Fault()))

    def _stall(self, act: p.Stall) -> None:
        disk, until = self.site.gateway.disk, self.world.now + act.seconds
        if act.full:
            disk.full = until
        else:
            disk.stalls = until
        self.world.tell("disk", f"{'is full' if act.full else 'stalls'} for {act.seconds:.2f} s")

    def _press(self, act: p.Press) -> None:
        self.site.press(True)
        self.world.after(act.seconds, lambda: self.site.press(False))

    def _take(self, act: p.Take) -> None:
        """A person takes the machine, moves it, and gives it back."""
        site, world = self.site, self.world

        def taken(answer: f.Effect) -> None:
            if isinstance(answer, f.Taken) and answer.wrong is None:
                world.tell("operator", "moves the machine by its levers")
                site.machine.plant.turn(LEVERS, world.now, act.seconds / 2)
                world.after(act.seconds, lambda: world.send("take", lambda: site.gateway.call(
                    lambda number: e.TakeAsked(number, "Sato", True), lambda _: None)))  # fmt: skip

        world.send("take", lambda: site.gateway.call(lambda number: e.TakeAsked(number, "Sato", False), taken))

    def _stranger(self, _act: p.Stranger) -> None:
        self.world.tell("stranger", "cancels all goals at the machine")
        self.world.send("stranger", self.site.machine.cancel)

    def _foreign(self, act: p.ForeignGoal) -> None:
        self.world.send("foreign", lambda: self.site.gateway.ask(None, act.seconds, lambda _: None))

    # invariants

    def _look(self) -> None:
        self._in_time()
        self._answered()
        self.world.after(LOOK, self._look)

    def _in_time(self) -> None:
        """A run's goal whose processes are lost does not move the machine for long while its gateway lives."""
        site = self.site
        gateway, ignores = site.gateway, site.machine.plant.fault.ignore_cancel
        if site.machine.plant.goal is None or ignores or not site.owned or gateway.worked_for() < 3.0:
            return
        for process in (site.scheduler, site.subtask):
            if process.lost_for() > STOP_IN_TIME and site.machine.ordered_to_stop < site.sent_at:
                raise Violation(f"{process.name} is lost for {process.lost_for():.1f} s, and the machine moves on")

    def _answered(self) -> None:
        """Whoever asks for a stop, a re-arm or a goal gets an answer, if the gateway works meanwhile."""
        gateway, now = self.site.gateway, self.world.now
        for since, _ in gateway.calls.values():
            if now - max(since, gateway.up_at) > ANSWERED and gateway.worked_for() > ANSWERED:
                raise Violation(f"a call is not answered within {ANSWERED:.0f} s")


def shorter(result: Result) -> Result:
    """The shortest plan found that violates an invariant with the same seed."""
    best = result
    for one in list(result.plan):
        rest = [other for other in best.plan if other is not one]
        tried = Schedule(result.seed, rest).run()
        if tried.violation:
            best = tried
    return best
