"""One run in the scheduler: it turns what happens into events of the decisions, and their effects into messages."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from simulation.disk import Entry
from simulation.order import Order
from simulation.relay import UNREACHED
from simulation.task import Leaf, Task, Tree, beside
from simulation.unit import PLANNER, SUBTASK, Unit
from simulation.world import Violation
from tms_decision.gateway import effects as g
from tms_decision.gateway import events as ge
from tms_decision.leaf import effects as lf
from tms_decision.leaf import events as le
from tms_decision.leaf.replay import Replay
from tms_decision.leaf.state import LeafGoal, LeafGoals
from tms_decision.leaf.step import ask
from tms_decision.leaf.step import step as leaf_step
from tms_decision.owner import Owner
from tms_decision.permit_link import NOBODY
from tms_decision.reasons import NoPermit, ProcessLost
from tms_decision.run import effects as rf
from tms_decision.run import events as re
from tms_decision.run.step import TICK_LIMIT, Phase, Run, step
from tms_reason.reason import Foreign, Reason
from tms_reason.wire import to_line
from tms_ts.reasons import ProcessState
from tms_ts.run_states import entered

if TYPE_CHECKING:
    from simulation.scheduler import Scheduler

TICK = 0.1  # s
RETRIES = 2
STORED = 5.0  # s for the facts of a run to be on the disk
RECEIPT = 13.0  # s for the receipt of a stop
LIMITS = {Phase.STOPPING: 14.0, Phase.SETTLING: 18.0}  # s that these phases take at most
WAITS = 10.5  # s that a goal waits for its server at most


class Execution:
    """One run; it exists as long as the scheduler lives."""

    def __init__(self, scheduler: Scheduler, run_id: str, task: Task, past: Any = None) -> None:
        """`past`: an interrupted run that is resumed."""
        self.scheduler, self.world, self.run_id, self.task = scheduler, scheduler.world, run_id, task
        self.number = scheduler.site.number()
        self.core = Run(resumed=past is not None)
        self.goals = LeafGoals(self.number, RETRIES, Replay(past.ended if past is not None else ()))
        self.goals.replay.beside = beside
        self.done_before = {key for key, succeeded in past.ended if succeeded} if past is not None else set()
        self.events = past.last_event if past is not None else 0
        self._numbers = 0
        self.orders: dict[int, tuple[Unit, Order, int, le.Key]] = {}  # by sending; with the subtask's life
        self.hangs = 0.0  # until then
        self._dead: dict[str, int] = {}  # machine -> life of a relay that is known to be gone
        self._tree = Tree(task, self._ask, self._cancel)
        self.units = [scheduler.site.units[name] for name in task.machines()]

    def begin(self) -> None:
        """Write its facts to the disk; then hold the permits and run."""
        self.scheduler.disk.line(self.run_id, {"run": self._header()})
        self._enter("preparing")
        self.scheduler.written(lambda: self._step(re.Prepared()))
        self.scheduler.later(STORED, lambda: self.refuse(Foreign("the disk is too slow")))

    def _header(self) -> dict[str, Any]:
        return {
            "run_id": self.run_id, "number": self.number, "task_id": 1, "description": "", "xml": "",
            "machines": self.task.machines(), "started": (0, 0), "values": {"task": self.task},
        }  # fmt: skip

    def refuse(self, why: Reason) -> None:
        """End it if no machine may move yet."""
        if self.core.phase is Phase.PREPARING and not self.core.held:
            self._step(re.Refused(why))

    def cancel(self) -> None:
        """An operator cancels the run."""
        self._step(re.EndAsked("cancelled", Foreign("by the operator")))

    def stopped(self, machine: str, cause: Reason) -> None:
        """A machine was stopped from outside."""
        self._step(re.StoppedOutside(machine, cause))

    def _tick(self) -> None:
        if self.core.phase is not Phase.RUNNING:
            return
        if self.world.now < self.hangs:
            self.scheduler.later(self.hangs - self.world.now, self._tick)
            return
        self._look()
        self._step(re.Ticked(self._tree.tick()))
        self.scheduler.later(TICK, self._tick)

    def _settle(self) -> None:
        if self.core.phase is Phase.SETTLING:
            self._look()
            self._step(re.Looked(not self.goals.settled(), [goal.name for goal in self.goals.open]))
            self.scheduler.later(TICK, self._settle)

    def hang(self, seconds: float) -> None:
        """Its thread hangs; its permits lapse if that lasts."""
        self.hangs = self.world.now + seconds
        for unit in self.units if self.core.held else []:
            self.scheduler.permits[unit.name].hangs(TICK_LIMIT, seconds)

    def in_time(self, now: float) -> None:
        """Raises Violation: it takes too long to end."""
        took, works = now - self.core.since, self.scheduler.worked_for()
        if min(took, works) > LIMITS.get(self.core.phase, float("inf")):
            raise Violation(f"{self.run_id} {self.core.phase.value} for {took:.1f} s")
        for goal in self.goals.open:
            waits = min(now - max(goal.begun, goal.not_before, self.hangs), works)
            if not goal.call and not self.goals.stopping and waits > WAITS:
                raise Violation(f"{self.run_id}: {goal.name} waits for {waits:.1f} s: {goal.reason!r}")

    def _step(self, event: re.Event) -> None:
        for effect in step(self.core, event, self.world.now):
            self._do(effect)

    def _do(self, effect: rf.Effect) -> None:
        disk = self.scheduler.disk
        match effect:
            case rf.Hold():
                self._hold()
            case rf.Drop():
                for unit in self.units:
                    self.scheduler.permits[unit.name].hold(NOBODY)
            case rf.Enter(state, why, ended):
                self._enter(state, why, ended)
            case rf.Halt():
                self._tree.halt()
                self._step(re.Halted(not self.goals.settled()))
            case rf.StopMachines():
                self._stop_all()
            case rf.Alarm(what):
                self._event("alarm", "", what)
            case rf.KeepEnd(outcome, why):
                disk.line(self.run_id, {"over": outcome, "reason": to_line(why)})
            case rf.KeepInterrupted():
                disk.line(self.run_id, {"interrupted": True})
            case rf.Forget():
                disk.forget(self.run_id)

    def _hold(self) -> None:
        for unit in self.units:
            permit = self.scheduler.permits[unit.name]
            permit.alive = lambda: self.core.works(self.world.now)
            permit.hold(Owner(self.number).goal_id(b"abc"), self.run_id)
        back = [one for unit in self.units if (one := self.scheduler.held_back(unit.name)) is not None]
        self._step(re.Held(back[0] if back else None))

    def _enter(self, state: str, why: Reason | None = None, ended: bool = False) -> None:
        self._event("run", "", entered(state, why))
        self.world.tell("tms:ts", f"{self.run_id} is {state}")
        if state == "running":
            self.scheduler.later(0.0, self._tick)
        if ended:
            self.scheduler.over(self, state)

    def _event(self, kind: str, node: str, what: Reason) -> None:
        self.events += 1
        self.scheduler.disk.line(self.run_id, {"n": self.events})
        self.scheduler.disk.tell(self.run_id, self.events, Entry(kind, node, what))

    # stops

    def _stop_all(self) -> None:
        waiting, unseen = [unit.name for unit in self.units], list[Reason]()

        def stood(name: str, receipt: g.Receipt | None) -> None:
            if name not in waiting:
                return
            waiting.remove(name)
            if receipt is None or not receipt.confirmed:
                unseen.append(Foreign(f"{name} was not seen to stand"))
            if not waiting:
                self._step(re.Stood(unseen))
                self._settle()

        for unit in self.units:
            self._stop(unit, lambda receipt, name=unit.name: stood(name, receipt))

    def _stop(self, unit: Unit, told: Any) -> None:
        """Have the gateway stop the machine; if it is lost meanwhile, its successor is asked again."""
        deadline, over = self.world.now + RECEIPT, list[bool]()

        def answered(effect: g.Effect) -> None:
            assert isinstance(effect, g.Stopped)
            if not over:
                over.append(True)
                told(effect.receipt)

        def ask_again(life: int) -> None:
            if over:
                return
            if self.world.now >= deadline:
                over.append(True)
                told(None)
            elif unit.gateway.works() and unit.gateway.life != life:
                self.world.send("stops", lambda: unit.gateway.call(_end_of_run, self.scheduler.in_life(answered)))
                self.scheduler.later(0.3, lambda life=unit.gateway.life: ask_again(life))  # type: ignore[misc]
            else:
                self.scheduler.later(0.3, lambda: ask_again(life))

        ask_again(0)

    # leaf goals

    def _ask(self, leaf: Leaf) -> LeafGoal:
        self._numbers += 1
        seen = self._seen(leaf.key)
        asked = le.GoalAsked(self._numbers, leaf.key, seen, UNREACHED, Foreign("its server is gone"))
        goal, effects = ask(self.goals, asked, self.world.now)
        self._do_leaf(effects)
        return goal

    def _cancel(self, goal: LeafGoal) -> None:
        self._leaf(le.CancelAsked(goal.asked.number))

    def _look(self) -> None:
        if self.goals.open:
            self._leaf(le.Looked({goal.asked.number: self._seen(goal.key) for goal in self.goals.open}))

    def _seen(self, key: le.Key) -> le.Seen:
        unit, scheduler = self.scheduler.site.units[key[1]], self.scheduler
        ready = scheduler.finds(unit.relays[SUBTASK], self._dead.get(unit.name, 0))
        return le.Seen(
            ready, unit.pids.get(SUBTASK), unit.age(SUBTASK), _trouble(unit, PLANNER), _trouble(unit, SUBTASK),
            machine=scheduler.obstacle(unit.name), latch=scheduler.latch(unit.name),
        )  # fmt: skip

    def _leaf(self, event: le.Event) -> None:
        self._do_leaf(leaf_step(self.goals, event, self.world.now))

    def _do_leaf(self, effects: list[lf.Effect]) -> None:
        life = self.scheduler.life
        for effect in effects:
            self._do_one(effect)
            self.scheduler.site.trap.sprung(type(effect).__name__)
            if not self.scheduler.alive or self.scheduler.life != life:
                return  # killed at this moment

    def _do_one(self, effect: lf.Effect) -> None:
        disk = self.scheduler.disk
        match effect:
            case lf.Send(key, call, owner):
                self._send(key, call, owner)
            case lf.Cancel(call):
                unit, order, _, _ = self.orders[call]
                self.world.send(f"{unit.name} leaf cancels", lambda: unit.relays[SUBTASK].cancel(order))
            case lf.Lose(call, dead):
                unit, _, life, _ = self.orders.pop(call)
                self._dead[unit.name] = life if dead else self._dead.get(unit.name, 0)
            case lf.StopMachine(machine):
                unit = self.scheduler.site.units[machine]
                self._stop(unit, lambda _, machine=machine: self._leaf(le.MachineStopped(machine)))
            case lf.Note(kind, node, what):
                self._event(kind, node, what)
            case lf.KeepSent(key):
                disk.line(self.run_id, {"sent": key}, urgent=True)
            case lf.KeepDone(key, succeeded):
                disk.line(self.run_id, {"done": key, "ok": succeeded}, urgent=True)
            case lf.KeepGone(key, left):
                self.done_before.discard(key)
                self.scheduler.finished.get(self.run_id, set()).discard(key)
                disk.line(self.run_id, {"gone": key, "left": left})

    def _send(self, key: le.Key, call: int, owner: Owner) -> None:
        if key in self.done_before or key in self.scheduler.finished.get(self.run_id, ()):
            raise Violation(f"{self.run_id} repeats {key}, which had succeeded before the interruption")
        if any(sent == key for _, _, _, sent in self.orders.values()):
            raise Violation(f"{self.run_id} sends {key[0]} again, and the goal that it has sent is open")
        unit, scheduler = self.scheduler.site.units[key[1]], self.scheduler
        seconds = next(leaf.seconds for branch in self.task.branches for leaf in branch if leaf.key == key)
        order = Order(
            self.world, f"{unit.name} leaf goals", owner, seconds,
            scheduler.in_life(lambda: self._leaf(le.Accepted(call))),
            scheduler.in_life(lambda outcome, why: self._ended(call, outcome, why)),
        )  # fmt: skip
        self.orders[call] = unit, order, unit.relays[SUBTASK].life, key
        self.world.tell("tms:ts", f"{self.run_id} sends {key[0]} to {unit.name}")
        self.world.send(order.topic, lambda: unit.relays[SUBTASK].ask(order))

    def _finished(self, key: le.Key, halted: bool) -> None:
        """A leaf goal has succeeded: when what is written now is on the disk, its end is.

        One that the tree halted before is not over for the tree: a resumed run does it again.
        """
        found = self.scheduler.finished.setdefault(self.run_id, set())
        self.scheduler.succeeded.add((self.run_id, key))
        if not halted:
            self.scheduler.later(0.0, lambda: self.scheduler.disk.after(lambda: found.add(key)))

    def _ended(self, call: int, outcome: str, why: Reason | None) -> None:
        if outcome == "SUCCEEDED" and call in self.orders:
            halted = any(goal.call == call and goal.cancelled for goal in self.goals.open)
            self._finished(self.orders[call][3], halted)
        self.orders.pop(call, None)
        reason, failure = why or Foreign("no reason"), le.NO_LOSS
        if reason == UNREACHED or reason.find(NoPermit) is not None:
            failure |= le.Failure.UNREACHED
        if reason.find(ProcessLost) is not None:
            failure |= le.Failure.LOST
        self._leaf(le.Ended(call, outcome, reason, failure))


def _trouble(unit: Unit, name: str) -> Reason | None:
    """What is wrong with a process, as far as the host agent has told."""
    return ProcessState(f"{unit.name}:{name}", "STARTING") if unit.pids.get(name) == 0 else None


def _end_of_run(number: int) -> ge.Event:
    return ge.StopAsked(number, Foreign("the end of a run"), True)
