"""Carries a plan out in the simulation, in virtual time."""

from collections import Counter
from collections.abc import Callable, Iterable
from typing import Any

from replay import acts as a
from replay.history import History, history
from replay.plans import MACHINES
from replay.seen import Answer, Player, Seen
from simulation import invariants
from simulation.disk import Entry
from simulation.gateway import State
from simulation.plant import Fault
from simulation.scheduler import Scheduler
from simulation.site import Site
from simulation.task import Leaf, Task
from simulation.unit import SUBTASK, Unit
from simulation.world import Process, World
from tms_cli.drill.record import Goal, MotionSample, Receipt, ReportedState, TrialRecording
from tms_decision.gateway import effects as f
from tms_decision.gateway import events as e
from tms_reason.reason import Foreign, Reason
from tms_reason.wire import to_line
from tms_ts.reasons import MachineBusy

LOOK = 0.02  # s
STILL = 0.01  # rad/s, of the machines of the simulation
SWINGS = {"left": 6.0, "right": 6.0}  # s
READY = 5.0  # s until all processes have found each other
BACK = 1.2  # s until a killed process is started again
FAULTS = {
    a.Fault.COASTS: Fault(coast=2.0),
    a.Fault.IGNORES_STOPS: Fault(ignore_cancel=True, ignore_emergency=True),
    a.Fault.SILENT: Fault(mute=True),
    a.Fault.FROZEN_STAMPS: Fault(frozen_stamp=True),
}
PERSON, LITTLE, PRESSED = "Sato", 1.5, 0.3  # s of a motion that a stranger asks for; s that the button is pressed


class OnDemand(Scheduler):
    """Begins runs that it is asked for, and no other."""

    def begin_some(self) -> None:
        """Nobody asks for anything."""

    def ask(self, run: str, task: Task) -> None:
        """A client asks for a run."""
        holder = next((one.run_id for one in self.runs.values() if one.task.machines() == task.machines()), "")
        self.begin_run(run, task)
        if holder:
            self.runs[run].refuse(MachineBusy(task.machines()[0], holder))


class Simulated:
    """One plan in one site."""

    def __init__(self, plan: a.Plan, seed: int) -> None:
        self.world = World(seed)
        self.site = Site(self.world, MACHINES, at_once=True, planner=True, scheduler=OnDemand)
        self.seen = Seen({name: TrialRecording() for name in MACHINES})
        self._plan = plan
        self._player = Player(plan, READY)
        self._doers: dict[type[Any], Callable[[Any], None]] = {
            a.Start: self._start, a.Cancel: self._cancel, a.Resume: self._resume, a.Press: self._press,
            a.Rearm: self._rearm, a.AskToMove: self._ask, a.Take: self._take, a.GiveBack: self._take,
            a.Kill: self._kill, a.Freeze: self._freeze, a.Restart: self._restart, a.BeUnkind: self._be_unkind,
            a.StallDisk: self._stall,
        }  # fmt: skip

    def run(self) -> Seen:
        """Let it happen.

        Raises:
            Violation: an invariant does not hold.
            Late: a moment of the plan does not come.
        """
        self.site.start()
        for unit in self.site.units.values():
            _Observer(self.world, unit, self.seen.machines[unit.name])
        self.world.at(READY, self._look)
        while not self._player.over:
            self.world.run(self.world.now + 1.0)
        return self.seen

    def _look(self) -> None:
        invariants.look(self.site)
        self._read_runs()
        act = self._player.due(self.seen, self.world.now)
        if act is not None:
            self.world.tell("plan", str(act))
            self._doers[type(act)](act)
        self.world.after(LOOK, self._look)

    def _read_runs(self) -> None:
        runs: dict[str, list[Entry]] = {}
        for (run, _), entry in sorted(self.site.scheduler.disk.journal.items(), key=lambda one: one[0]):
            runs.setdefault(run, []).append(entry)
        self.seen.runs = runs

    def _unit(self, act: Any) -> Unit:
        return self.site.units[act.machine]

    # people

    def _start(self, act: a.Start) -> None:
        keys = [(f"0.0.{at}", act.machine, SUBTASK, name) for at, name in enumerate(act.leaves)]
        task, scheduler = Task((tuple(Leaf(key, SWINGS[key[3]], 1) for key in keys),)), self.site.scheduler
        assert isinstance(scheduler, OnDemand)
        scheduler.handle(lambda: scheduler.ask(act.run, task))

    def _cancel(self, act: a.Cancel) -> None:
        scheduler = self.site.scheduler
        scheduler.handle(lambda: scheduler.runs[act.run].cancel())

    def _resume(self, _: a.Resume) -> None:
        self.site.scheduler.handle(self.site.scheduler.resume)

    def _press(self, _: a.Press) -> None:
        self.site.press_for(PRESSED)

    def _rearm(self, act: a.Rearm) -> None:
        self.site.arm(self._unit(act), lambda answer: self._told(act, answer.wrong))

    def _ask(self, act: a.AskToMove) -> None:
        ended = lambda outcome, why: self._told(act, None if outcome == "SUCCEEDED" else why or Foreign(outcome))  # noqa: E731
        self.site.foreign(self._unit(act), LITTLE, ended)

    def _take(self, act: a.Take | a.GiveBack) -> None:
        back = isinstance(act, a.GiveBack)

        def told(answer: f.Effect) -> None:
            self._told(act, answer.wrong if isinstance(answer, f.Taken) else None)

        self.site.call(self._unit(act).gateway, lambda number: e.TakeAsked(number, PERSON, back), told)

    def _told(self, act: a.Question, wrong: Reason | None) -> None:
        self.seen.answers.append(Answer(type(act).__name__, wrong))

    # faults

    def _kill(self, act: a.Kill) -> None:
        for process in self._processes(act, act.processes):
            self.site.kill(process, BACK)

    def _restart(self, act: a.Restart) -> None:
        for process in self._processes(act, (act.process,)):
            self.site.restart(process, BACK)

    def _freeze(self, act: a.Freeze) -> None:
        for process in self._processes(act, act.processes):
            process.freeze(act.seconds)

    def _processes(self, act: Any, names: tuple[str, ...]) -> list[Process]:
        return [self.site.process(SUBTASK if name == a.SUBTASK else name, self._unit(act)) for name in names]

    def _be_unkind(self, act: a.BeUnkind) -> None:
        self.site.fault(self._unit(act), Fault() if act.fault is None else FAULTS[act.fault])

    def _stall(self, act: a.StallDisk) -> None:
        until = self.world.now + act.seconds
        self.site.scheduler.disk.stalls = until
        for unit in self.site.units.values():
            unit.gateway.notes.stalls = until


def histories(plan: a.Plan, seeds: Iterable[int]) -> Counter[History]:
    """How often the simulation tells each history of a plan; most plans have one."""
    return Counter(history(Simulated(plan, seed).run()) for seed in seeds)


class _Observer:
    """Sees one machine, as a client does that subscribes to its topics."""

    def __init__(self, world: World, unit: Unit, record: TrialRecording) -> None:
        self._world, self._unit, self._record = world, unit, record
        unit.machine.watched = self._goal
        unit.hear_state("observer", self._state)
        unit.hears_receipts["observer"] = self._receipt
        self._sample()

    def _sample(self) -> None:
        now, plant = self._world.now, self._unit.machine.plant
        plant.advance(now)
        joints = {self._unit.name: plant.angle}
        self._record.truth.append(MotionSample(now, abs(plant.speed) / STILL, joints, (0.0, 0.0)))
        self._world.after(LOOK, self._sample)

    def _goal(self, number: int, word: str) -> None:
        if word == "accepted":
            self._record.goals[number.to_bytes(16, "big")] = Goal(self._world.now)
        else:
            goal = self._record.goals[number.to_bytes(16, "big")]
            goal.ended, goal.arrived = self._world.now, word == "SUCCEEDED"

    def _state(self, state: State) -> None:
        self._record.states.append(ReportedState(self._world.now, to_line(state.latch), to_line(state.hold)))

    def _receipt(self, receipt: f.Receipt) -> None:
        cause, detail, begun = to_line(receipt.cause), to_line(receipt.detail), receipt.stamp - self._unit.wall
        self._record.receipts.append(Receipt(begun, receipt.seconds, receipt.confirmed, cause, detail, self._world.now))
