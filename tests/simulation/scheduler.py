"""The scheduler: it runs tasks, closes what a lost predecessor left open, and resumes that for an operator."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from simulation.disk import Entry, RunDisk
from simulation.execution import Execution
from simulation.gateway import State
from simulation.host import alone, press
from simulation.lease import FORGET, Asserted, PermitProcess
from simulation.relay import Relay
from simulation.task import Task, some_task
from simulation.unit import Orphan, Unit
from simulation.world import Violation
from tms_decision.duty import Press
from tms_decision.gateway import effects as f
from tms_decision.leaf.events import Key
from tms_decision.owner import Owner
from tms_decision.past import CLOSE_LIMIT, LostRun, Stop, all_told, stops_of, what_was_seen
from tms_decision.permit_link import PermitLink
from tms_decision.reasons import DrivenByHand, MachineLatched, SeenToStand, SoftwareStop
from tms_decision.run.step import Phase
from tms_reason import wire
from tms_reason.reason import Foreign, Reason
from tms_ts.interrupted_run import InterruptedRun
from tms_ts.run_states import entered

if TYPE_CHECKING:
    from simulation.site import Site

LATE = 1.3  # s after the end or the loss of a run in which its last goal may leave
FOUND = 3.0  # s for processes to find each other, on a busy PC
SETTLED = 1.5  # s
PAUSE = 0.5  # s between runs, at most twice as much


class Scheduler(PermitProcess):
    """Runs tasks again and again on the machines that are free."""

    def __init__(self, site: Site) -> None:
        super().__init__(site.world, "tms:ts", {name: unit.permits["ts"] for name, unit in site.units.items()})
        self.site, self.disk = site, RunDisk(site.world)
        self.runs: dict[str, Execution] = {}
        self.told: dict[str, str] = {}  # outcomes that clients know
        self._receipts: list[Stop] = []
        self._states: dict[str, State] = {}
        self._presses: dict[str, Press] = {}
        self._gateways: dict[str, PermitLink] = {}
        self._last = 0
        self._ended: dict[int, float] = {}  # when runs have ended, by fencing number
        self.finished: dict[str, set[Key]] = {}  # leaf goals that have succeeded, and whose end must be on the disk
        self.succeeded: set[tuple[str, Key]] = set()  # run and leaf goal, as soon as that is known
        self.hung_at = float("inf")  # when its runs last began to hang

    def start(self) -> None:
        self.begin()
        self.runs, self._states, self._receipts = {}, {}, []
        self.hung_at, self._presses = float("inf"), {name: Press() for name in self.site.units}
        self._gateways = {name: PermitLink("rc") for name in self.site.units}
        for name, unit in self.site.units.items():
            link = self._gateways[name]
            unit.permits["rc"].join(
                f"ts{self.life}",
                self.in_life(lambda goal, holder, link=link: link.heard(goal, holder, self.world.now)),
                self.in_life(lambda alive, stale, name=name: self._reported(name, alive, stale)),
            )
            unit.hear_state("ts", self.in_life(lambda state, name=name: self._state(name, state)))
            unit.hears_receipts["ts"] = self.in_life(lambda receipt, name=name: self._receipt(name, receipt))
            for old in unit.receipts[-20:]:  # the topic is latched
                self._receipt(name, old)
        self._close_all(self.world.now + CLOSE_LIMIT)
        settled = SETTLED if self.life == 1 else 0.0  # the gateways have just started, too
        self.later(settled + self.world.random.random(), self.begin_some)

    def kill(self) -> None:
        for run in self.runs.values() if self.works() else ():  # a frozen one was lost before
            for unit in run.units if run.core.held else ():
                gateway = unit.gateway
                if gateway.notes.run != run.number:
                    continue  # since the machine was last seen to stand, no goal of it has left
                if self.permits[unit.name].asserted is not Asserted.ALIVE:
                    continue  # of a run that hangs: lost before, and a person may have armed the machine since
                unit.orphan = Orphan(run.number, self.world.now, gateway.life, gateway.worked_for())
        super().kill()
        self.disk.killed()

    # runs

    def begin_some(self) -> None:
        """Begin a run on some of the machines that are free; after a crash, an operator resumes one if that goes."""
        random = self.world.random
        free = [name for name in self._free() if self.held_back(name) is None]
        if self.life > 1 and self.life % 2 == 0:
            free = self._resumed(free, " at once")
        if free:
            self._last += 1
            machines = random.sample(free, random.randint(1, len(free)))
            self.begin_run(f"run-{self.life}-{self._last}", some_task(random, machines))
        self.later(PAUSE * (1.0 + random.random()), self.begin_some)

    def _resumed(self, free: list[str], how: str) -> list[str]:
        """Resume the first interrupted run whose machines are all free; returns those that are left."""
        for run_id, lines in self.disk.checkpoints.items():
            past = InterruptedRun(lines)
            header = past.header
            if header is None or not past.closed or run_id in self.runs or not {*header.machines} <= {*free}:
                continue
            self.world.tell("operator", f"resumes {run_id}{how}")
            self.begin_run(run_id, header.values["task"], past)
            return [name for name in free if name not in header.machines]
        return free

    def _free(self) -> list[str]:
        """Machines that no run has."""
        held = {name for run in self.runs.values() for name in run.task.machines()}
        return [name for name in self.site.units if name not in held]

    def begin_run(self, run_id: str, task: Task, past: InterruptedRun | None = None) -> None:
        """Begin a run, or go on with one that was interrupted."""
        for key, succeeded in past.ended if past is not None else ():
            if succeeded and (run_id, key) not in self.succeeded:
                raise Violation(f"{run_id} is resumed without {key}, which has not succeeded")
        self.runs[run_id] = run = Execution(self, run_id, task, past)
        run.begin()

    def resume(self) -> None:
        """An operator resumes an interrupted run, if there is one and its machines are free."""
        self._resumed(self._free(), "")

    def cancel(self) -> None:
        """An operator cancels a run."""
        for run in list(self.runs.values())[:1]:
            self.world.tell("operator", f"cancels {run.run_id}")
            run.cancel()

    def over(self, run: Execution, outcome: str) -> None:
        """A run has ended; its client gets to know it when the end is on the disk."""
        del self.runs[run.run_id]
        self._ended[run.number] = self.world.now
        for unit in run.units if outcome in ("success", "failure", "cancelled") else []:
            if unit.machine.plant.goal is not None and unit.owner is not None and unit.owner.run == run.number:
                raise Violation(f"{run.run_id} has ended as {outcome}, and its goal moves {unit.name}")
        if outcome not in ("interrupted", "refused"):
            self.written(lambda: self.told.__setitem__(run.run_id, outcome))

    def written(self, step: Callable[[], None]) -> None:
        """Do a step when everything so far is on the disk, in this life."""
        self.disk.after(self.in_life(step))

    # runs that a predecessor left open

    def _close_all(self, deadline: float) -> None:
        left = {run_id: InterruptedRun(lines) for run_id, lines in self.disk.checkpoints.items()}
        for run_id, past in left.items():
            if run_id in self.told and past.over is None:
                raise Violation(
                    f"the client of {run_id} knows its end {self.told[run_id]}, and its checkpoint does not"
                )
            if past.header is not None and past.over is not None:
                self._complete(run_id, past)
        self._close_open(list(left), deadline)

    def _complete(self, run_id: str, past: InterruptedRun) -> None:
        """Report the end of a run that had ended before: that report may be lost, or comes twice."""
        assert past.over is not None
        why = wire.of(past.over.reason)
        self.disk.tell(run_id, past.over.event, Entry("run", "", entered(past.over.outcome, why)))
        self.disk.forget(run_id)

    def _close_open(self, left: list[str], deadline: float) -> None:
        waits: list[str] = []  # one that is closed may be resumed, and is no longer left open
        for run_id in left:
            past = InterruptedRun(self.disk.checkpoints.get(run_id, ()))
            header = past.header
            if header is None or past.closed or past.over is not None or run_id in self.runs:
                continue
            lost = past.lost(header)
            stops = stops_of(lost, self._receipts)
            if not all_told(lost, stops) and self.world.now < deadline:
                waits.append(run_id)
                continue
            reason, unseen = what_was_seen(lost, stops)
            self._check_claim(lost, reason)
            self.world.tell("tms:ts", f"{run_id} is interrupted: {reason!r}")
            alarms = [Entry("alarm", "", alarm) for alarm in unseen]
            ended = Entry("run", "", entered("interrupted", reason))
            for number, entry in enumerate([*alarms, ended], past.last_event + 1):
                self.disk.line(run_id, {"n": number})
                self.disk.tell(run_id, number, entry)
            self.disk.line(run_id, {"interrupted": True})
        if waits:
            self.later(0.2, lambda: self._close_open(waits, deadline))

    def _check_claim(self, lost: LostRun, reason: Reason) -> None:
        claim = reason.find(SeenToStand)
        for name in claim.machines if claim is not None else ():
            unit = self.site.units[name]
            if unit.owner is not None and unit.owner.run == lost.number and unit.machine.plant.goal is not None:
                raise Violation(f"{lost.run_id}: {name} was seen to stand, and a goal of that run moves it")

    def check_owner(self, unit: Unit, owner: Owner | None) -> None:
        """A goal of a run leaves for a machine: that run must hold the machine, or have held it a moment ago."""
        if self.lost_for() > 0 or self.worked_for() < LATE:
            return
        if owner is None:
            return self._check_foreign(unit)
        holds = any(run.number == owner.run and unit in run.units and run.core.held for run in self.runs.values())
        if not holds and self.world.now - self._ended.get(owner.run, float("-inf")) > LATE:
            raise Violation(f"a goal of {owner} leaves for {unit.name}, and that run does not hold it")

    def _check_foreign(self, unit: Unit) -> None:
        """A foreign goal leaves for a machine: no run holds that, as far as its gateway must know by now."""
        now = self.world.now
        for run in self.runs.values() if unit.gateway.worked_for() > FOUND and unit.second is None else ():
            ticks = run.core.phase is Phase.RUNNING and now - max(run.core.since, run.hangs) > LATE
            if ticks and unit in run.units and self.worked_for() > FOUND:
                raise Violation(f"a foreign goal leaves for {unit.name}, which {run.run_id} holds")

    def hang(self, seconds: float) -> None:
        """The threads of its runs hang, and the process does not."""
        self.hung_at = self.world.now
        for run in self.runs.values():
            run.hang(seconds)

    # what others tell

    def _reported(self, name: str, alive: int, stale: int) -> None:
        now = self.world.now
        self._gateways[name].reported(alive, stale, False, now)
        if alive == 0:
            self._presses[name].due(now, alive=False, latched=None)

    def _state(self, name: str, state: State) -> None:
        self._states[name] = state
        now = self.world.now
        if self._presses[name].due(now, alone(self._gateways[name], now), state.latch is not None):
            self.hand_on(name)
        run = next((run for run in self.runs.values() if name in run.task.machines() and run.core.held), None)
        if run is not None and state.latch is not None:
            run.stopped(name, state.latch)

    def _receipt(self, name: str, receipt: f.Receipt) -> None:
        self._receipts.append(Stop(name, receipt.run, receipt.stamp, receipt.confirmed, receipt.latched, receipt.cause))

    def pressed(self) -> None:
        """The stop button is pressed."""
        for one in self._presses.values():
            one.since = self.world.now
        for run in [run for run in self.runs.values() if run.core.held]:
            run.stopped(run.units[0].name, SoftwareStop())

    def hand_on(self, name: str) -> None:
        """Tell a gateway of a press that it does not know."""
        self.world.tell(self.name, f"hands a press on to {name}:rc")
        self.world.send(f"{name} calls", lambda: self.site.units[name].gateway.call(press, lambda _: None))

    def latch(self, name: str) -> Reason | None:
        """Why the machine is latched, as far as is known."""
        state = self._states.get(name)
        return state.latch if state is not None else None

    def held_back(self, name: str) -> Reason | None:
        """A state that only a person ends."""
        state = self._states.get(name)
        if state is None:
            return None
        if state.latch is not None:
            return MachineLatched(name, state.latch)
        return DrivenByHand(state.by_hand, name) if state.by_hand is not None else None

    def obstacle(self, name: str) -> Reason | None:
        """Why a goal would not move the machine now."""
        state = self._states.get(name)
        if state is None:
            return None
        if not self._gateways[name].alive(self.world.now):
            return Foreign("its gateway is away")
        return self.held_back(name) or (None if state.ready else Foreign("it is not ready"))

    def finds(self, relay: Relay, dead: int) -> bool:
        """Whether discovery shows its server; one that is gone is shown for a while. `dead`: life known to be gone."""
        return relay.life > dead and (relay.alive or self.world.now - relay.lost_at < FORGET)
