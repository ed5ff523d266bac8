"""A whole stand-in: joints, tracks, faults, and its time. Pure logic."""

import math
import threading
from collections.abc import Callable, Sequence

from tms_config.models import DRIVE, Border, MachineModel
from tms_config.site_file import Fault
from tms_sim.arm import Arm
from tms_sim.base import Base
from tms_sim.controller import Controller
from tms_sim.joint_commands import JointCommands
from tms_sim.navigator import Navigator
from tms_sim.soil import Feeling, Stance, joints_in_soil
from tms_sim.tracks import ZERO
from tms_sim.turner import Turner

MAX_STEP = 0.04  # s a step, so that goals end and faults begin equally exactly at any time scale
CREEPS = 3.0  # s of stand-still after which the fault `creep` begins


class StandIn:
    """All moving parts, with one common time. `die` is called when the fault of that name strikes."""

    def __init__(
        self,
        model: MachineModel,
        start: tuple[float, float, float],
        fault: Fault,
        die: Callable[[], None],
        border: Border | None = None,
        ideal: bool = False,
    ) -> None:
        """`ideal`: without dead time and lag."""
        self._border = border or Border()
        response = {} if ideal else model.responses(self._border)
        self.arm = Arm(model.joints, {**model.initial, **self._border.initial}, response)
        self.controller = Controller(self.arm)
        self.turner = Turner(self.arm, self._border.dump_returns)
        self.commands = JointCommands(self.arm, self._border.joints)
        self.base = Base(model.drive, start, response.get(DRIVE)) if model.drive else None
        self.navigator = Navigator(self.base) if self.base else None
        tool = model.bucket or model.blade
        self.ground = Feeling(tool.force if tool else math.inf)
        self._pushes = self.base if model.blade else None  # tracks that push a blade through soil
        self._in_soil = [self.arm.servos[joint] for joint in joints_in_soil(model)]
        self.fault = fault
        self.time = 0.0  # s
        self._die = die
        self._pressed = False  # level of the emergency stop
        self._releases = 0  # count of releases: a delayed stop is void when it was released since
        self._in_motion = 0.0  # s since the first of the open goals
        self._stood = 0.0  # s since it came to stand
        self._leaking = 0.0  # m/s, rad/s
        self._later: list[tuple[float, Callable[[], object]]] = []
        self._lock = threading.Lock()  # guards the delayed commands

    @property
    def fault(self) -> Fault:
        """The present fault."""
        return self._fault

    @fault.setter
    def fault(self, fault: Fault) -> None:
        self._fault = fault
        self.arm.more_dead_time = fault.dead_time
        if self.base is not None:
            self.base.more_dead_time = fault.dead_time

    @property
    def busy(self) -> bool:
        """Whether a goal is open."""
        return self.controller.busy or self.turner.busy or (self.navigator is not None and self.navigator.busy)

    def stop(self, on: bool) -> None:
        """Set the level of the emergency stop."""
        if not on:
            self.later(lambda: self._stop(False))
        elif not self.fault.ignore_emg_stop:
            releases = self._releases
            self._order_stop(lambda: self._stop(True) if releases == self._releases else None)

    def _stop(self, on: bool) -> None:
        for part in (self.controller, self.turner, self.commands, self.navigator):
            if part is not None:
                part.stop(on)
        if on and not self._pressed:  # the position when it was pressed is held
            self.arm.halt(self._border.emg_stop_at_once)
            if self.base is not None:
                self.base.halt(self._border.emg_stop_at_once)
        self._pressed = on
        self._releases += not on

    def cancel(self, command: Callable[[], object]) -> None:
        """Cancel a goal, unless the fault `ignore_cancel` is on."""
        if not self.fault.ignore_cancel:
            self._order_stop(command)

    def drive(self, v: float, w: float) -> None:
        """Take a velocity command [m/s, rad/s]; zero is an order to stop."""
        base, navigator = self.base, self.navigator
        if base is not None and navigator is not None and not navigator.emergency:
            order = self._order_stop if max(abs(v), abs(w)) < ZERO else self.later
            order(lambda: base.command(v, w))

    def turn(self, names: Sequence[str], control: int, position: Sequence[float], velocity: Sequence[float]) -> None:
        """Take a joint command; goals have priority."""
        if not self.busy:
            self.later(lambda: self.commands.take(names, control, position, velocity))

    def feel(self, resistance: float, stands: Stance) -> None:
        """Take what it feels of the ground; the resistance is in N."""
        self.ground.tell(self.time, resistance, stands)

    def later(self, command: Callable[[], object]) -> None:
        """Run a command now, or with the fault `late` that many seconds of the machine's time later."""
        self._after(self.fault.late, command)

    def _order_stop(self, command: Callable[[], object]) -> None:
        """Run an order to stop; with the fault `coast` it takes effect later."""
        self._after(self.fault.late + self.fault.coast, command)

    def _after(self, seconds: float, command: Callable[[], object]) -> None:
        if seconds:
            with self._lock:
                self._later.append((self.time + seconds, command))
        else:
            command()

    def step(self, seconds: float) -> None:
        """Let time pass."""
        while seconds > 1e-9:
            if self._sleeps():
                self.time, self._stood, self._in_motion = self.time + seconds, self._stood + seconds, 0.0
                return
            part = min(seconds, MAX_STEP)
            self._step(part)
            seconds -= part

    def _sleeps(self) -> bool:
        """Whether the state cannot change by time alone."""
        moves = (
            self.fault.drift
            or self.fault.creep
            or self._leaking
            or not self.arm.still
            or not (self.base is None or self.base.still)
        )
        return not (self.busy or self._later or moves)

    def _step(self, seconds: float) -> None:
        self.time += seconds
        for command in self._due():
            command()
        busy = self.busy
        self._in_motion = self._in_motion + seconds if busy else 0.0
        self._strike(busy)
        self._leak(busy, seconds)
        share = self.ground.share(self.time)
        for servo in self._in_soil:
            servo.resist(share)
        if self._pushes is not None:
            self._pushes.resist(share)
        self.controller.step(seconds)
        self.turner.step(seconds)
        if not busy:
            self.commands.step()
        if self.navigator is not None:
            self.navigator.step(seconds)

    def _due(self) -> list[Callable[[], object]]:
        with self._lock:
            due = [command for time, command in self._later if time <= self.time]
            self._later = [one for one in self._later if one[0] > self.time]
        return due

    def _strike(self, busy: bool) -> None:
        fault = self.fault
        if fault.die is not None and busy and self._in_motion >= fault.die:
            self._die()
        self.arm.stuck = stuck = fault.stall is not None and busy and self._in_motion >= fault.stall
        if self.base is not None:
            self.base.stuck = stuck

    def _leak(self, busy: bool, seconds: float) -> None:
        """Move the machine without a command, by the faults `drift` and `creep`."""
        base = self.base
        moves = busy or self.arm.driven or (base is not None and (base.v != 0.0 or base.w != 0.0))
        self._stood = 0.0 if moves else self._stood + seconds
        velocity = (0.0 if busy else self.fault.drift) + (self.fault.creep if self._stood >= CREEPS else 0.0)
        self._leaking = velocity
        self.arm.leak(velocity, seconds)
        if base is not None:
            base.leak = velocity
