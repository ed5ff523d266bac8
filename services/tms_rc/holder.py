"""Holds the joints of a machine that our own controller moves: after a stop, only the gateway writes to its drives."""

import threading
from collections.abc import Callable, Mapping

from tms_config.clock import monotonic
from tms_config.models import DRIVE
from tms_control.holding import Holding
from tms_machine.border import Controls
from tms_machine.facts import longest_dead_time
from tms_machine.joint_commands import JointCommands
from tms_runtime.app import App


class Holder:
    """Takes the commands of stops, which never wait, and sends what holds the joints at every beat of the pulse."""

    def __init__(self, app: App, controls: Controls, positions: Callable[[], Mapping[str, float]]) -> None:
        """`positions`: the joints' angles [rad] as measured just now, none while they are not heard."""
        model, border = app.site.model_of(app.machine), app.site.border(app.machine)
        response = {name: one for name, one in model.responses(border).items() if name != DRIVE}
        dead_time = longest_dead_time(model, border)
        self._pulse, self._controls, self._positions = app.pulse, controls, positions
        self._joints = set(response)
        self._commands = JointCommands(app.ros, app.machine, border, single=True)
        self._holding = Holding(dead_time, {name: one.droop for name, one in response.items()})
        self._lock = threading.Lock()  # guards the decisions; held for moments

    def zero(self) -> None:
        """Command zero speed, and hold the joints."""
        self._controls.zero()
        with self._lock:
            self._holding.stop(monotonic())
        self._pulse.add(self._beat)
        self._beat()

    def emergency(self, on: bool) -> None:
        """Press the machine's own stop, or release it as soon as that is safe."""
        with self._lock:
            if on:
                self._holding.press()
            else:
                self._holding.release(monotonic())
        if on:
            self._controls.emergency(True)
        else:
            self._pulse.add(self._beat)

    def settling(self) -> bool:
        """Whether commands of a stop are still to be sent, or may still be on their way: a goal would be lost."""
        with self._lock:
            busy = self._holding.busy
        return busy or self._controls.settling()

    def _beat(self) -> None:
        measured = {name: angle for name, angle in self._positions().items() if name in self._joints}
        with self._lock:
            orders = self._holding.step(monotonic(), measured)
            busy = self._holding.busy
        if orders.release:
            self._controls.emergency(False)
        if orders.angles:
            self._commands.send(orders.angles)
        if not busy:
            self._pulse.remove(self._beat)
