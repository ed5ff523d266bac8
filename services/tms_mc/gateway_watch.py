"""Whether the gateway stands behind its machine: without it, nothing is moved."""

from prometheus_client import Counter

from tms_machine.permit import RemotePermit
from tms_runtime.app import App

LAPSED = Counter("tms_mc_permits_lapsed_total", "How often the gateway was taken for lost")


class GatewayWatch:
    """The permit of the machine's gateway."""

    def __init__(self, app: App) -> None:
        self._lived = False
        self._permit = RemotePermit(app.ros, app.pulse, app.machine, "rc", self._changed)

    @property
    def alive(self) -> bool:
        """Whether the gateway lives: its permits come ten times a second, and lapse after half a second."""
        return self._permit.alive

    def _changed(self, permit: RemotePermit) -> None:
        if self._lived and not permit.alive:
            LAPSED.inc()
        self._lived = permit.alive
