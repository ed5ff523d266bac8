"""A site in virtual time: machines with their processes, a scheduler, a host agent, people, foreign clients."""

from collections.abc import Callable, Iterable
from itertools import count

from simulation.disk import Notes
from simulation.gateway import GatewayProcess
from simulation.host import HostAgent
from simulation.order import Ended, Order
from simulation.plant import Fault
from simulation.scheduler import Scheduler
from simulation.unit import PLANNER, SUBTASK, Trap, Unit
from simulation.world import Process, Violation, World
from tms_decision.gateway import effects as f
from tms_decision.gateway import events as e

LEVERS = 0.2  # rad/s of a person at the levers


class Site:
    """All of it."""

    def __init__(
        self, world: World, names: Iterable[str], *, at_once: bool, planner: bool, passive: bool = False,
        slow: bool = False, scheduler: type[Scheduler] = Scheduler,
    ) -> None:  # fmt: skip
        """`names`: of its machines."""
        self.world, self._numbers, self.trap, self._slow = world, count(100), Trap(), slow
        self.units = {
            name: Unit(world, name, self._numbers, at_once=at_once, planner=planner, passive=passive) for name in names
        }
        self.host = HostAgent(list(self.units.values()))
        for unit in self.units.values():
            unit.host = self.host
        self.scheduler = scheduler(self)
        for unit in self.units.values():
            unit.check_owner = self.scheduler.check_owner

    def number(self) -> int:
        return next(self._numbers)

    def start(self) -> None:
        """Everything starts."""
        self.host.start()
        for unit in self.units.values():
            unit.start()
            for name in unit.relays:
                self.host.noticed(unit, name)
        self.scheduler.start()

    def process(self, name: str, unit: Unit) -> Process:
        """A process by its role; those of a machine are those of this one."""
        shared: dict[str, Process] = {"ts": self.scheduler, "host": self.host, "rc": unit.gateway}
        return shared.get(name) or unit.relays.get(name) or unit.relays[SUBTASK]

    def ended(self, process: Process) -> None:
        """A process was killed, or has started: the host agent sees that of those it started."""
        for unit in self.units.values():
            for name, relay in unit.relays.items():
                if relay is process:
                    self.host.noticed(unit, name)

    def kill(self, process: Process, again: float) -> None:
        """Kill a process, which is started again after some seconds."""
        if process.alive:
            process.kill()
            self._start_again(process, again)

    def restart(self, process: Process, again: float) -> None:
        """End a process in order, where it knows how to; it is started again after some seconds."""
        if process.alive:
            getattr(process, "end", process.kill)()
            self._start_again(process, again)

    def _start_again(self, process: Process, seconds: float) -> None:
        def start() -> None:
            if not process.alive:
                process.start()
                self.ended(process)

        self.ended(process)
        self.world.after(seconds, start)

    # people

    def press(self, on: bool) -> None:
        """An operator at the button, which all gateways hear."""
        self.world.tell("operator", "presses stop" if on else "releases the button")

        def arrives(gateway: GatewayProcess) -> None:
            if gateway.works() and on:
                gateway.latched, gateway.pressed_at = True, self.world.now
                gateway.heard_with = [(one, one.life) for one in (gateway, self.host, self.scheduler)]
            gateway.happens(e.Signal(on))

        for process in (self.host, self.scheduler) if on else ():
            self.world.send(f"{process.name} button", lambda process=process: process.handle(process.pressed))  # type: ignore[misc]
        for unit in self.units.values():
            missed = on and not unit.gateway.works() and unit.second is None  # the latch of a second one hides it
            unit.missed = self.world.now if missed else unit.missed
            for gateway in unit.gateways():
                self.world.send(f"{gateway.name} button", lambda gateway=gateway: arrives(gateway))  # type: ignore[misc]

    def press_for(self, seconds: float) -> None:
        """An operator presses the button, and releases it."""
        self.press(True)
        self.world.after(seconds, lambda: self.press(False))

    def rearm(self) -> None:
        """An operator looks at every machine, and arms those that stand."""
        self.world.tell("operator", "re-arms")
        for unit in self.units.values():
            self.arm(unit)

    def arm(self, unit: Unit, told: Callable[[f.Rearmed], None] = lambda answer: None) -> None:
        """Both steps of a re-arm; `told` gets the answer to the last one."""
        gateway, token = unit.gateway, f"token{self.number()}"

        def answered(answer: f.Effect) -> None:
            assert isinstance(answer, f.Rearmed)
            if answer.token:
                given = self.world.now
                if self._slow:
                    self.world.after(0.3 + 2.0 * self.world.random.random(), lambda: confirm(answer.token, given))
                else:
                    confirm(answer.token, given)
            else:
                told(answer)

        def confirm(token: str, given: float) -> None:
            stopped = False

            def asks(number: int) -> e.Event:
                nonlocal stopped
                stopped = gateway.pressed_at > given
                return e.RearmAsked(number, token, "")

            self.call(gateway, asks, lambda answer: armed(answer, stopped))

        def armed(answer: f.Effect, stopped: bool) -> None:
            assert isinstance(answer, f.Rearmed)
            if answer.wrong is None and stopped:
                raise Violation(f"{gateway.name} is armed, and was stopped after its token was given out")
            told(answer)

        self.call(gateway, lambda number: e.RearmAsked(number, "", token), answered)

    def take(self, unit: Unit, seconds: float) -> None:
        """A person takes a machine, moves it, and gives it back."""
        world, gateway = self.world, unit.gateway

        def taken(answer: f.Effect) -> None:
            if isinstance(answer, f.Taken) and answer.wrong is None:
                world.tell("operator", f"moves {unit.name} by its levers")
                unit.machine.plant.turn(LEVERS, world.now, seconds / 2)
                unit.driven = True
                world.after(seconds, give_back)

        def give_back() -> None:
            unit.driven = False
            self.call(gateway, lambda number: e.TakeAsked(number, "Sato", True), lambda _: None)

        self.call(gateway, lambda number: e.TakeAsked(number, "Sato", False), taken)

    def levers(self, unit: Unit, seconds: float) -> None:
        """Somebody moves a machine by its levers without a word to anybody."""
        now = self.world.now
        self.world.tell("somebody", f"moves {unit.name} by its levers, untold")
        unit.machine.plant.turn(LEVERS, now, seconds)
        unit.levers = now, now + seconds

    def call(
        self, gateway: GatewayProcess, event: Callable[[int], e.Event], answer: Callable[[f.Effect], None]
    ) -> None:
        """Call a service of a gateway."""
        self.world.send(f"{gateway.name} calls", lambda: gateway.call(event, answer))

    # strangers

    def stranger(self, unit: Unit) -> None:
        """A stranger cancels all goals at a machine."""
        self.world.tell("stranger", f"cancels all goals at {unit.name}")
        self.world.send("stranger", unit.machine.cancel)

    def foreign(self, unit: Unit, seconds: float, ended: Ended = lambda outcome, why: None) -> None:
        """A client without a run asks for a motion."""
        order = Order(self.world, "foreign", None, seconds, ended=ended)
        self.world.send("foreign", lambda: unit.gateway.ask(order))

    def second_gateway(self, unit: Unit, seconds: float) -> None:
        """Somebody starts a second gateway on another PC; both serve until they find each other, then one ends."""
        if unit.second is not None:
            return
        unit.second = second = GatewayProcess(unit, f"{unit.name}:rc2", Notes(self.world))
        second.start()
        unit.missed = float("inf")  # its latch, of a machine that it knows nothing of, looks like the effect of a press

        def found() -> None:
            unit.second = None
            if second.alive:
                second.end()

        self.world.after(seconds, found)

    def fault(self, unit: Unit, fault: Fault) -> None:
        """A machine becomes unkind, or kind again."""
        self.world.tell(unit.name, f"is now {fault}")
        unit.lies_since = self.world.now if fault != unit.machine.plant.fault else unit.lies_since
        if unit.machine.plant.fault.replay and not fault.replay:
            unit.replayed_at = self.world.now
        unit.machine.plant.fault = fault


ROLES = ("rc", "ts", SUBTASK, "host", PLANNER)
