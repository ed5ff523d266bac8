"""The mode lamp of a machine, where its border has one: told with each state, so a lamp that hears nothing knows it."""

from std_msgs.msg import String
from tms_msg_rc.msg import MachineState

from tms_hardware.lamp import mode
from tms_runtime.app import App


class Lamp:
    """The lamp of one machine."""

    def __init__(self, app: App) -> None:
        border, machine = app.site.border(app.machine), app.machine
        topic = f"/{machine}/{border.lamp}"
        self._publisher = app.ros.publisher(String, topic, depth=1, latched=True) if border.lamp else None

    def show(self, state: MachineState) -> None:
        """Show the mode of a state."""
        if self._publisher is not None:
            self._publisher.publish(String(data=mode(bool(state.by_hand), state.armed, state.ready)))
