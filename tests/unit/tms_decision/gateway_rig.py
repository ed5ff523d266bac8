"""A gateway's decisions with a machine that obeys, a disk that answers, and a client that waits. Pure."""

from dataclasses import replace
from typing import Any

from simulation.plant import JOINT, PERIOD, Plant, facts
from tms_decision.gateway import effects as f
from tms_decision.gateway import events as e
from tms_decision.gateway.step import start, step
from tms_decision.owner import Owner
from tms_decision.permit_link import NOBODY
from tms_proof.standstill import JOINTS
from tms_reason.reason import Reason

BEAT = 0.05
RUN = Owner(7)
LEAF = Owner(7, 1, 0)  # what the subtask stands behind
GOAL = Owner(7, 1, 1)  # and the goal that it sends
SERVER = "/zx200/controller"
TURN = 0.5  # rad/s of every goal


class Rig:
    """One gateway. `run` lets time pass."""

    def __init__(self, left: e.Left | None = None, *, at_once: bool = False, jumps: float = 0.0) -> None:
        self.now, self.wall = 100.0, 1e9
        self.plant, self.disk_answers, self.server_answers = Plant(at_once), True, True
        self.look = e.Beat(0.0)
        self.done: list[f.Effect] = []
        self.sent: dict[int, float] = {}  # goal -> seconds of its motion
        self.lasts: dict[int, float] = {}
        self.told = 0.0
        self.disk_problem: Reason | None = None
        machine = replace(facts(at_once=at_once), jumps=jumps)
        self.gateway, effects = start(machine, "zx200:rc", ["swing"], left or e.Left(None), self.now, self.wall)
        self.do(effects)
        self.happens(e.StandsIn(False))  # the host agent has seen it come

    def happens(self, event: e.Event) -> None:
        """Let something happen."""
        self.do(step(self.gateway, event, self.now))

    def do(self, effects: list[f.Effect]) -> None:
        for effect in effects:
            self.done.append(effect)
            self._do(effect)

    def _do(self, effect: f.Effect) -> None:
        match effect:
            case f.Emergency(on):
                self.plant.emergency = on
                if on:
                    self._ends(self.plant.halt(self.now, by_emergency=True), "ABORTED")
            case f.Zero() | f.CancelAll():
                self._ends(self.plant.halt(self.now), "CANCELED")
            case f.Send(number):
                if self.server_answers:
                    taken = self.plant.accept(number, self.lasts[number], TURN, self.now)
                    self.happens(e.CallAccepted(number) if taken else e.CallEnded(number, "REJECTED"))
            case f.KeepState(number) | f.KeepDriver(number):
                if self.disk_answers:
                    self.happens(e.NoteKept(number, self.disk_problem))
            case f.Look():
                self.happens(replace(self.look, wall=self.wall + self.now))
            case f.KeepReceipt(stop):
                if self.disk_answers:
                    self.happens(e.ReceiptKept(stop))
            case _:
                pass

    def _ends(self, goal: int | None, outcome: str) -> None:
        if goal is not None:
            self.happens(e.CallEnded(goal, outcome))

    def run(self, seconds: float) -> "Rig":
        """Let time pass, with beats and the machine's messages."""
        end = self.now + seconds
        while self.now < end - 1e-9:
            self.now += BEAT
            if self.now - self.told >= PERIOD - 1e-9:
                self.told = self.now
                sample = self.plant.tell(self.now)
                if sample is not None:
                    self.happens(e.Sampled(JOINTS, sample))
            self._ends(self.plant.done(self.now), "SUCCEEDED")
            self.happens(replace(self.look, wall=self.wall + self.now))
        return self

    # what people and processes do

    def permits(self, scheduler: Owner | None = RUN, subtask: Owner | None = LEAF) -> None:
        """The processes stand behind a run, or behind none."""
        for name, owner in (("ts", scheduler), ("swing", subtask)):
            goal = NOBODY if owner is None else owner.goal_id(b"abc")
            self.happens(e.PermitHeard(name, goal, "run-1" if owner is not None else ""))
            self.happens(e.PermitReported(name, 1, 0, False))

    def lose(self, name: str) -> None:
        """The lease of a process runs out."""
        self.happens(e.PermitReported(name, 0, 1, False))

    def ask(self, number: int, owner: Owner | None = None, seconds: float = 5.0, **more: Any) -> None:
        """A client asks for a motion."""
        self.lasts[number] = seconds
        angle = self.gateway.watch.positions.get(JOINT, 0.0)
        way = e.Reference((JOINT,), [(at, (angle + TURN * at,)) for at in (0.1, seconds)])
        self.happens(e.GoalAsked(number, f"goal {number}", owner, SERVER, **{"motion": way, "lasts": seconds, **more}))

    def moving(self, number: int = 1, owner: Owner | None = None, seconds: float = 5.0) -> "Rig":
        """Let a goal move the machine."""
        self.ask(number, owner, seconds)
        self.run(1.0)
        assert self.plant.speed > 0.0, self.done
        return self

    def rearm(self) -> f.Rearmed:
        """Both steps of a re-arm."""
        self.happens(e.RearmAsked(1, "", "t0ken"))
        self.run(0.1)
        self.happens(e.RearmAsked(2, "t0ken", ""))
        self.run(0.1)
        return self.all(f.Rearmed)[-1]

    def all(self, kind: Any) -> list[Any]:
        """The effects of a kind so far."""
        return [one for one in self.done if isinstance(one, kind)]

    @property
    def end(self) -> f.End:
        """The last answer to a client."""
        return self.all(f.End)[-1]

    @property
    def receipt(self) -> f.Receipt:
        """The last receipt that was told."""
        return self.all(f.Tell)[-1].receipt


def ready(**more: Any) -> Rig:
    """A gateway whose start is over, and whose machine stands."""
    rig = Rig(**more).run(3.0)
    rig.done.clear()
    return rig


def latched(**more: Any) -> Rig:
    """A gateway whose machine a person has stopped, and that stands."""
    rig = ready(**more)
    rig.happens(e.Signal(True))
    rig.happens(e.Signal(False))
    return rig.run(2.0)


def rearming() -> tuple[Rig, f.KeepState]:
    """A latched gateway whose re-arm waits for the disk, and the note that it waits for."""
    rig = latched()
    rig.happens(e.RearmAsked(1, "", "t0ken"))
    rig.disk_answers = False
    rig.happens(e.RearmAsked(2, "t0ken", ""))
    return rig, rig.all(f.KeepState)[-1]
