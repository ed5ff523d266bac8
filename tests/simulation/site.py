"""A site in virtual time: machine, gateway, host agent, scheduler, subtask, operator, foreign client, disk."""

from collections.abc import Callable
from dataclasses import dataclass, replace

from simulation.lease import Permit
from simulation.plant import JOINT, PERIOD, Fault, Plant, facts
from simulation.world import Process, Violation, World
from tms_decision.duty import Act, Duty, GatewayStatus
from tms_decision.gateway import effects as f
from tms_decision.gateway import events as e
from tms_decision.gateway.state import Gateway
from tms_decision.gateway.step import start, step
from tms_decision.owner import Owner
from tms_decision.permit_link import NOBODY, PermitLink
from tms_decision.reasons import NoNote
from tms_proof.standstill import JOINTS
from tms_reason.reason import Reason

BEAT, PROOF_BEAT = 0.05, 0.025
GATEWAY = bytes([255]) * 16
MACHINE, SUBTASK = "zx200", "swing"
SPEED = 0.3  # rad/s of every goal
SETTLES = 0.5  # s in which a machine takes the commands of a stop
STOP_IN_TIME = 1.3  # s from a loss until the machine must have been told to stop


@dataclass
class Disk:
    """What survives: the note of the state, and receipts. It may stall, or be full."""

    armed: bool = False
    holder: str = ""
    run: int = 0
    cause: Reason | None = None
    driver: str = ""
    unproven: bool = False
    known: bool = False  # whether it was ever written
    stalls: float = 0.0  # until then
    full: float = 0.0  # until then


class Machine:
    """The machine with its server; commands come by messages."""

    def __init__(self, world: World, at_once: bool) -> None:
        self.world, self.plant = world, Plant(at_once)
        self.told: Callable[[e.Event], None] = lambda event: None
        self.open: dict[int, Callable[[str], None]] = {}
        self.ordered_to_stop = 0.0  # when it last received an order to stop
        world.after(PERIOD, self._beat)

    def _beat(self) -> None:
        now = self.world.now
        sample = self.plant.tell(now)
        if sample is not None:
            self.told(e.Sampled(JOINTS, sample))
        self._ends(self.plant.done(now), "SUCCEEDED")
        self.world.after(PERIOD, self._beat)

    def zero(self) -> None:
        self._halt(False, "ABORTED")

    def cancel(self) -> None:
        self._halt(False, "CANCELED")

    def emergency(self, on: bool) -> None:
        self.plant.emergency = on and not self.plant.fault.ignore_emergency
        if on:
            self._halt(True, "ABORTED")

    def _halt(self, pressed: bool, outcome: str) -> None:
        self.ordered_to_stop = self.world.now
        self._ends(self.plant.halt(self.world.now, pressed), outcome)

    def send(self, goal: int, seconds: float, answer: Callable[[str], None]) -> None:
        """A goal arrives; `answer` is called with `accepted`, and with its outcome."""
        if self.plant.fault.silent_server:
            return
        if not self.plant.accept(goal, seconds, SPEED, self.world.now):
            answer("REJECTED")
            return
        self.open[goal] = answer
        self.world.tell("machine", f"accepts goal {goal} for {seconds:.1f} s")
        answer("accepted")

    def _ends(self, goal: int | None, outcome: str) -> None:
        if goal is not None and goal in self.open:
            self.world.tell("machine", f"goal {goal} ends: {outcome}")
            self.open.pop(goal)(outcome)


@dataclass
class Asked:
    """A goal at the gateway."""

    owner: Owner | None
    seconds: float
    answer: Callable[[f.End], None]


class PermitProcess(Process):
    """A process with a permit, whose lease lapses when it is killed or frozen."""

    def __init__(self, site: "Site", name: str, permit: str) -> None:
        super().__init__(site.world, name)
        self.site, self.permit = site, Permit(site.world, f"permit/{permit}", self)

    def kill(self) -> None:
        super().kill()
        self.permit.killed()

    def freeze(self, seconds: float) -> None:
        if self.alive and not self.frozen():
            self.permit.frozen(seconds)
        super().freeze(seconds)


class GatewayProcess(PermitProcess):
    """The gateway's decisions in a process that may be killed or frozen."""

    def __init__(self, site: "Site") -> None:
        super().__init__(site, f"{MACHINE}:rc", "rc")
        self.disk = Disk()
        self.core: Gateway | None = None
        self.asked: dict[int, Asked] = {}
        self.calls: dict[int, tuple[float, Callable[[f.Effect], None]]] = {}
        self.latched = False  # a person has pressed stop, and nobody has armed since: no goal may leave
        self._writes = 0.0  # when the disk has done what waits
        self._settles = float("-inf")  # when the last command of a stop left

    def start(self) -> None:
        self.begin()
        self.asked, self.calls = {}, {}
        disk, now = self.disk, self.world.now
        latched = None if disk.armed else (disk.cause or NoNote())
        left = e.Left(latched, disk.holder if disk.armed else "", disk.run if disk.armed else 0, disk.driver,
                      disk.unproven and not disk.armed)  # fmt: skip
        self.core, effects = start(facts(at_once=self.site.machine.plant.at_once), self.name, [SUBTASK], left, now, 1e9)
        self._do(effects)
        for name, permit in self.site.permits.items():
            permit.join(
                f"{self.name}{self.life}",
                self._in_life(lambda goal, holder, name=name: self._happens(e.PermitHeard(name, goal, holder))),
                self._in_life(
                    lambda alive, stale, name=name: self._happens(e.PermitReported(name, alive, stale, False))
                ),
            )
        self.later(0.5, lambda: self.permit.hold(GATEWAY, ""))
        self._beat()

    def _in_life(self, step: Callable[..., None]) -> Callable[..., None]:
        life = self.life
        return lambda *words: self.handle(lambda: step(*words)) if self.life == life else None

    def kill(self) -> None:
        super().kill()
        self.core = None

    def _beat(self) -> None:
        core = self.core
        assert core is not None
        self._look()
        self.later(PROOF_BEAT if core.proves() else BEAT, self._beat)

    def _look(self) -> None:
        self._happens(e.Beat(1e9 + self.world.now, settling=self.world.now - self._settles < SETTLES))

    def happens(self, event: e.Event) -> None:
        """Something happens to the process, if it lives."""
        self.handle(lambda: self._happens(event))

    def _happens(self, event: e.Event) -> None:
        core = self.core
        if core is not None:
            self._do(step(core, event, self.world.now))

    def ask(self, owner: Owner | None, seconds: float, answer: Callable[[f.End], None]) -> None:
        """A client's goal arrives."""

        def take() -> None:
            core = self.core
            assert core is not None
            number = self.site.number()
            self.asked[number] = Asked(owner, seconds, answer)
            angle = core.watch.positions.get(JOINT, 0.0)
            way = e.Reference((JOINT,), [(at, (angle + SPEED * at,)) for at in (0.1, seconds)])
            self.world.tell(self.name, f"is asked for goal {number} of {owner}")
            self._happens(e.GoalAsked(number, f"goal {number}", owner, "controller", motion=way, lasts=seconds))

        self.handle(take)

    def call(self, event: Callable[[int], e.Event], answer: Callable[[f.Effect], None]) -> None:
        """A service call arrives."""

        def take() -> None:
            number = self.site.number()
            self.calls[number] = self.world.now, answer
            self._happens(event(number))

        self.handle(take)

    # effects

    def _do(self, effects: list[f.Effect]) -> None:
        for effect in effects:
            self._one(effect)

    def _one(self, effect: f.Effect) -> None:
        machine, send = self.site.machine, self.world.send
        match effect:
            case f.Zero():
                send("zero", machine.zero)
            case f.Emergency(on):
                self._settles = float("-inf") if on else self.world.now
                send("emergency", lambda: machine.emergency(on))
                if on:
                    send("pressed", lambda: self.happens(e.Pressed()))
            case f.CancelAll():
                self._settles = self.world.now
                send("cancel", machine.cancel)
            case f.Cancel() | f.Lose() | f.GiveUp():
                send("cancel", machine.cancel)
            case f.Send(number):
                self._send(number)
            case f.End(number):
                self._end(effect)
            case f.Stopped(request) | f.Rearmed(request) | f.Taken(request):
                self._answer(request, effect)
            case f.KeepState() | f.KeepDriver() | f.KeepReceipt():
                self._keep(effect)
            case f.Look():
                self._look()
            case f.Tell(receipt):
                self.world.tell(self.name, f"tells: confirmed={receipt.confirmed} {receipt.cause!r} {receipt.detail!r}")
            case f.Log(event, values):
                self.world.tell(self.name, f"logs {event} {values}")
            case _:
                pass

    def _send(self, number: int) -> None:
        if self.latched:
            raise Violation(f"goal {number} leaves after a stop, before a re-arm")
        if not self.disk.armed or not self.disk.holder:
            raise Violation(f"goal {number} leaves, and the note does not say whose it is")
        self.world.tell(self.name, f"sends goal {number}")
        self.site.goals_sent += 1
        self.site.sent_at, self.site.owned = self.world.now, self.asked[number].owner is not None
        seconds, life = self.asked[number].seconds, self.life

        def answer(word: str) -> None:
            event = e.CallAccepted(number) if word == "accepted" else e.CallEnded(number, word)
            self.world.send("answers", lambda: self.happens(event) if self.life == life else None)

        self.world.send("goals", lambda: self.site.machine.send(number, seconds, answer))

    def _end(self, end: f.End) -> None:
        asked = self.asked.pop(end.number)
        self.world.tell(self.name, f"ends goal {end.number}: {end.outcome} {end.why!r}")
        self.world.send("results", lambda: asked.answer(end))

    def _answer(self, request: int, effect: f.Effect) -> None:
        _, answer = self.calls.pop(request)
        if isinstance(effect, f.Rearmed) and effect.armed:
            self.latched = False
        self.world.send("results", lambda: answer(effect))

    def _keep(self, effect: f.KeepState | f.KeepDriver | f.KeepReceipt) -> None:
        disk, now = self.disk, self.world.now
        if isinstance(effect, f.KeepReceipt) and effect.receipt.confirmed and self.site.machine.plant.moves():
            raise Violation(f"confirmed and truly moving: {effect.receipt.cause!r}")
        done = max(now, self._writes, disk.stalls) + 0.001 + self.world.random.random() * 0.01
        self._writes = done
        life = self.life

        def write() -> None:
            if not self.alive or self.life != life:
                return
            full = self.world.now < disk.full
            event = self._written(effect, full)
            self.happens(event)

        self.world.at(done, write)

    def _written(self, effect: f.KeepState | f.KeepDriver | f.KeepReceipt, full: bool) -> e.Event:
        disk = self.disk
        if isinstance(effect, f.KeepReceipt):
            if not full:
                disk.unproven = False
            return e.ReceiptKept(effect.stop, "No space left on device" if full else "")
        problem = NoNote() if full else None
        if isinstance(effect, f.KeepDriver):
            disk.driver = disk.driver if full else effect.who
        elif effect.latched is not None:  # deleting a note works on a full disk
            disk.armed, disk.cause, disk.unproven = False, None if full else effect.latched, True
            problem = None
        elif not full:
            disk.armed, disk.holder, disk.run = True, effect.holder, effect.run
        return e.NoteKept(effect.number, problem)


class HostAgent(Process):
    """Stands in for a lost gateway."""

    def __init__(self, site: "Site") -> None:
        super().__init__(site.world, "tms:host")
        self.site = site
        self.duty, self.link = Duty(), PermitLink("rc")

    def start(self) -> None:
        self.begin()
        self.duty, self.link = Duty(), PermitLink("rc")
        link, world = self.link, self.world
        self.site.gateway.permit.join(
            f"host{self.life}",
            lambda goal, holder: self.handle(lambda: link.heard(goal, holder, world.now)),
            lambda alive, stale: self.handle(lambda: link.reported(alive, stale, False, world.now)),
        )
        self._beat()

    def _beat(self) -> None:
        gateway, machine = self.site.gateway, self.site.machine
        busy = machine.plant.moves() or machine.plant.goal is not None
        status = GatewayStatus(
            self.link.alive(self.world.now), self.link.left, gateway.alive and not gateway.frozen(), busy
        )
        act = self.duty.check(self.world.now, status)
        if act is not None:
            self.world.tell(self.name, f"stands in: {act.value}")
            self.world.send("zero2", machine.zero)
            if act is Act.EMERGENCY:
                self.world.send("emergency2", lambda: machine.emergency(True))
                self.world.send("stood_in", lambda: gateway.happens(e.StoodIn()))
                self.world.send("pressed2", lambda: gateway.happens(e.Pressed()))
            self.world.send("cancel2", machine.cancel)
        self.later(BEAT, self._beat)


class Subtask(PermitProcess):
    """Passes the leaf goals of runs on to the gateway."""

    def __init__(self, site: "Site") -> None:
        super().__init__(site, f"{MACHINE}:{SUBTASK}", SUBTASK)

    def ask(self, owner: Owner, seconds: float, answer: Callable[[bool], None]) -> None:
        def take() -> None:
            life = self.life
            self.permit.hold(owner.goal_id(b"abc"), "")

            def ended(end: f.End) -> None:
                if self.life == life and self.alive:
                    self.permit.hold(NOBODY, "")
                    self.world.send("leaf results", lambda: answer(end.outcome == "SUCCEEDED"))

            self.world.send(
                "goals to rc",
                lambda: self.site.gateway.ask(owner.next(), seconds, lambda end: self.handle(lambda: ended(end))),
            )

        self.handle(take)


class Scheduler(PermitProcess):
    """Runs a task of a few leaves again and again; each leaf up to three times."""

    def __init__(self, site: "Site") -> None:
        super().__init__(site, "tms:ts", "ts")
        self.run_number = 0
        self.leaf = 0

    def start(self) -> None:
        self.begin()
        self.later(self.world.random.random(), self._run)

    def _run(self) -> None:
        self.run_number = self.site.number()
        self.world.tell(self.name, f"run {self.run_number} begins")
        self.permit.hold(Owner(self.run_number).goal_id(b"abc"), f"run-{self.run_number}")
        self.later(0.05, lambda: self._leaf(self.world.random.randint(1, 3), 0))

    def _leaf(self, left: int, tries: int) -> None:
        if not left or tries > 2:
            self._over()
            return
        self.leaf += 1
        leaf, run = self.leaf, self.run_number
        seconds = 1.0 + 4.0 * self.world.random.random()
        done: list[bool] = []

        def answer(succeeded: bool) -> None:
            if done or run != self.run_number:
                return
            done.append(succeeded)
            if succeeded:
                self._leaf(left - 1, 0)
            else:
                self.later(0.5, lambda: self._leaf(left, tries + 1))

        self.world.send("leaf goals", lambda: self.site.subtask.ask(
            Owner(run, leaf, 0), seconds, lambda ok: self.handle(lambda: answer(ok))))  # fmt: skip
        self.later(seconds + 14.0, lambda: answer(False))

    def _over(self) -> None:
        """The end of a run: its machine is stopped first."""
        run = self.run_number

        def stopped(_: f.Effect) -> None:
            if run == self.run_number:
                self.permit.hold(NOBODY, "")
                self.later(0.5 + self.world.random.random(), self._run)

        answered = lambda answer: self.handle(lambda: stopped(answer))  # noqa: E731
        asked = lambda number: e.StopAsked(number, None, True)  # noqa: E731
        self.world.send("stops", lambda: self.site.gateway.call(asked, answered))
        self.later(14.0, lambda: stopped(f.Look()) if self.permit.goal != NOBODY else None)


@dataclass
class Site:
    """All of it."""

    world: World
    at_once: bool = False
    sent_at: float = float("-inf")  # when the last goal left for the machine ...
    goals_sent: int = 0
    owned: bool = False  # ... and whether it was a run's
    numbers: int = 100

    def __post_init__(self) -> None:
        self.machine = Machine(self.world, self.at_once)
        self.scheduler, self.subtask = Scheduler(self), Subtask(self)
        self.permits = {"ts": self.scheduler.permit, SUBTASK: self.subtask.permit}
        self.gateway, self.host = GatewayProcess(self), HostAgent(self)
        self.machine.told = self._told

    def number(self) -> int:
        self.numbers += 1
        return self.numbers

    def _told(self, event: e.Event) -> None:
        self.world.send("telemetry", lambda: self.gateway.happens(self._arrived(event)))

    def _arrived(self, event: e.Event) -> e.Event:
        """The middleware stamps the arrival, also while the process is frozen."""
        if isinstance(event, e.Sampled):
            return e.Sampled(event.source, replace(event.sample, received=self.world.now))
        return event

    def start(self) -> None:
        """Everything starts; the machine is armed first."""
        self.gateway.disk.armed = True
        self.gateway.start()
        self.host.start()
        self.subtask.begin()
        self.scheduler.start()

    def press(self, on: bool) -> None:
        """An operator at the button."""
        self.world.tell("operator", "presses stop" if on else "releases the button")

        def arrives() -> None:
            gateway = self.gateway
            if gateway.alive and not gateway.frozen() and on:
                gateway.latched = True
            gateway.happens(e.Signal(on))

        self.world.send("button", arrives)

    def rearm(self) -> None:
        """An operator looks at the machine, and arms it if it stands."""
        self.world.tell("operator", "re-arms")

        def answered(answer: f.Effect) -> None:
            if isinstance(answer, f.Rearmed) and answer.token:
                self.world.send("rearm", lambda: self.gateway.call(
                    lambda number: e.RearmAsked(number, answer.token, ""), lambda _: None))  # fmt: skip

        token = f"token{self.number()}"
        self.world.send("rearm", lambda: self.gateway.call(lambda number: e.RearmAsked(number, "", token), answered))

    def fault(self, fault: Fault) -> None:
        """The machine becomes unkind, or kind again."""
        self.world.tell("machine", f"is now {fault}")
        self.machine.plant.fault = fault
