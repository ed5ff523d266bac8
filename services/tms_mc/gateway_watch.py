"""Whether the gateway stands behind its machine: without it, nothing is moved."""

from tms_machine.permit import RemotePermit
from tms_runtime.app import App


class GatewayWatch:
    """The permit of the machine's gateway."""

    def __init__(self, app: App) -> None:
        self._permit = RemotePermit(app.ros, app.pulse, app.machine, "rc", lambda _: None)

    @property
    def alive(self) -> bool:
        """Whether the gateway lives: its permits come twenty times a second, and lapse after half a second."""
        return self._permit.alive
