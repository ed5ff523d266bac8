"""A stand-in machine as a whole: joints, tracks, what goes wrong, and its time. Pure logic."""

from collections.abc import Callable, Sequence

from tms_core.models import Border, MachineModel
from tms_core.site_file import Fault
from tms_sim.arm import Arm
from tms_sim.base import Base
from tms_sim.controller import Controller
from tms_sim.joint_commands import JointCommands
from tms_sim.travel import Travel
from tms_sim.turner import Turner


class StandIn:
    """Everything that moves, in one time. `die` is called when the fault of that name strikes."""

    def __init__(
        self,
        model: MachineModel,
        start: tuple[float, float, float],
        seed: int,
        fault: Fault,
        die: Callable[[], None],
        border: Border | None = None,
    ) -> None:
        border = border or Border()
        self.arm = Arm(model.joints, model.initial, seed)
        self.controller = Controller(self.arm)
        self.turner = Turner(self.arm, border.dump_returns)
        self.commands = JointCommands(self.arm, border.joints)
        self.base = Base(model.drive, start) if model.drive else None
        self.travel = Travel(self.base) if self.base else None
        self.fault = fault
        self.time = 0.0  # s
        self._die = die
        self._in_motion = 0.0  # s since the first of the open goals
        self._later: list[tuple[float, Callable[[], object]]] = []

    @property
    def busy(self) -> bool:
        """Whether a goal is open."""
        return self.controller.busy or self.turner.busy or (self.travel is not None and self.travel.busy)

    def stop(self, on: bool) -> None:
        """Level of the emergency stop; with a late machine it comes late, too."""
        self.later(lambda: self._stop(on))

    def _stop(self, on: bool) -> None:
        for part in (self.controller, self.turner, self.commands, self.travel):
            if part is not None:
                part.stop(on)
        if self.base is not None and on:
            self.base.hold()

    def drive(self, v: float, w: float) -> None:
        """A velocity command [m/s, rad/s]."""
        base, travel = self.base, self.travel
        if base is not None and travel is not None and not travel.emergency:
            self.later(lambda: base.command(v, w))

    def turn(self, names: Sequence[str], control: int, position: Sequence[float], velocity: Sequence[float]) -> None:
        """A joint command; a goal goes first."""
        if not self.busy:
            self.later(lambda: self.commands.take(names, control, position, velocity))

    def later(self, command: Callable[[], object]) -> None:
        """Do it now, or `late` seconds of the machine's time from now."""
        if self.fault.late:
            self._later.append((self.time + self.fault.late, command))
        else:
            command()

    def step(self, seconds: float) -> None:
        """Let time pass."""
        self.time += seconds
        due = [one for one in self._later if one[0] <= self.time]
        self._later = [one for one in self._later if one[0] > self.time]
        for _, command in due:
            command()
        busy = self.busy
        self._in_motion = self._in_motion + seconds if busy else 0.0
        self._strike(busy)
        self.controller.step(seconds)
        self.turner.step(seconds)
        if not busy:
            self.commands.step()
        if self.base is not None and self.travel is not None:
            self.base.step(seconds)
            self.travel.step(seconds)
        if self.fault.drift and not busy:
            self._creep(self.fault.drift * seconds)

    def _strike(self, busy: bool) -> None:
        fault = self.fault
        if fault.die is not None and busy and self._in_motion >= fault.die:
            self._die()
        stuck = fault.stall is not None and busy and self._in_motion >= fault.stall
        self.arm.stuck = stuck
        if self.base is not None:
            self.base.stuck = stuck

    def _creep(self, way: float) -> None:
        self.arm.positions[0] += way
        if self.base is not None:
            self.base.x += way

    @property
    def creeping(self) -> float:
        """Velocity [m/s, rad/s] at which it drifts while it should stand."""
        return 0.0 if self.busy else self.fault.drift
