"""A schedule: a site in which things go wrong by a plan; invariants are looked at all the time."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from simulation import invariants
from simulation import plan as p
from simulation.plan import SECONDS, Planned
from simulation.plant import Fault
from simulation.scenes import planned
from simulation.site import Site
from simulation.unit import Unit
from simulation.world import Happened, Violation, World

LOOK = 0.1  # s between looks at the invariants
AGAIN = 1.0  # s until a process that has ended in order is started again


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
        self.seed, self.plan = seed, planned(seed) if plan is None else plan
        self.world = World(seed)
        self.site = Site(
            self.world,
            [f"m{number}" for number in range(p.machines(seed))],
            at_once=seed % 2 == 0,
            planner=seed % 3 == 0,
            passive=p.passive(seed),
            slow=seed % 4 == 1,
        )
        self._units = list(self.site.units.values())
        site = self.site
        self._doers: dict[type[Any], Callable[[Unit, Any], None]] = {
            p.Kill: self._kill, p.Freeze: self._freeze, p.Lie: self._lie, p.Stall: self._stall,
            p.Press: lambda _unit, act: site.press_for(act.seconds),
            p.Restart: self._restart, p.Clock: self._clock, p.Rearm: lambda _unit, _act: site.rearm(),
            p.Take: lambda unit, act: site.take(unit, act.seconds),
            p.Cancel: lambda _unit, _act: site.scheduler.handle(site.scheduler.cancel),
            p.Resume: lambda _unit, _act: site.scheduler.handle(site.scheduler.resume),
            p.SecondGateway: lambda unit, act: site.second_gateway(unit, act.seconds),
            p.Trapped: self._trapped,
            p.Hang: lambda _unit, act: site.scheduler.handle(lambda: site.scheduler.hang(act.seconds)),
            p.Stranger: lambda unit, _: site.stranger(unit),
            p.Levers: lambda unit, act: site.levers(unit, act.seconds),
            p.ForeignGoal: lambda unit, act: site.foreign(unit, act.seconds),
        }  # fmt: skip

    def run(self) -> Result:
        """Let it happen."""
        world, site, violation = self.world, self.site, ""
        try:
            site.start()
            for one in self.plan:
                world.at(one.at, lambda one=one: self._do(one))  # type: ignore[misc]
            world.after(LOOK, self._look)
            world.run(SECONDS)
        except Violation as found:
            violation = str(found)
            world.tell("VIOLATION", violation)
        return Result(
            self.seed, self.plan, world.events, sum(unit.goals for unit in self._units), violation, world.history
        )

    # what goes wrong

    def _do(self, one: Planned) -> None:
        unit = self._units[one.unit]
        self._doers[type(one.act)](unit, one.act)

    def _kill(self, unit: Unit, act: p.Kill) -> None:
        for name, again in zip(act.processes, act.again, strict=True):
            self.site.kill(self.site.process(name, unit), again)

    def _trapped(self, unit: Unit, act: p.Trapped) -> None:
        process = self.site.process(act.process, unit)

        def kill() -> None:
            if process.alive:
                self.world.tell("trap", f"{act.effect} is done")
                self.site.kill(process, act.again)

        step = kill if not act.delay else lambda: self.world.after(act.delay, kill)
        for trap in (unit.trap, self.site.trap):
            trap.set(act.effect, step)

    def _restart(self, unit: Unit, act: p.Restart) -> None:
        """A scheduler that ends in order interrupts its runs first: that is like a cancel, and not done here."""
        process = self.site.process(act.process, unit)
        if process is not self.site.scheduler:
            self.site.restart(process, AGAIN)

    def _freeze(self, unit: Unit, act: p.Freeze) -> None:
        for name in act.processes:
            self.site.process(name, unit).freeze(act.seconds)

    def _lie(self, unit: Unit, act: p.Lie) -> None:
        self.site.fault(unit, act.fault)
        self.world.after(act.seconds, lambda: self.site.fault(unit, Fault()))

    def _stall(self, unit: Unit, act: p.Stall) -> None:
        notes, until = unit.gateway.notes, self.world.now + act.seconds
        if act.full:
            notes.full = until
        else:
            notes.stalls = self.site.scheduler.disk.stalls = max(until, notes.stalls)
        self.world.tell("disk", f"{'is full' if act.full else 'stalls'} for {act.seconds:.2f} s")

    def _clock(self, unit: Unit, act: p.Clock) -> None:
        self.world.tell("clock", f"of {unit.name} {'itself' if act.machine else 'at its PC'} is set by {act.seconds} s")
        if act.machine:
            unit.machine.clock += act.seconds
        else:
            unit.wall += act.seconds

    def _look(self) -> None:
        invariants.look(self.site)
        self.world.after(LOOK, self._look)


def shorter(result: Result) -> Result:
    """The shortest plan found that violates an invariant with the same seed."""
    best = result
    for one in list(result.plan):
        rest = [other for other in best.plan if other is not one]
        tried = Schedule(result.seed, rest).run()
        if tried.violation:
            best = tried
    return best
