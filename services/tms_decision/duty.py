"""The duty of a host agent: it stops a machine in place of its lost gateway (see tms_host.standby)."""

from enum import Enum

from tms_decision.data import Data

LEASE_MARGIN = 0.09  # s more than the lease: a process frozen for 0.4 s may have asserted itself 0.1 s before
AGAIN = 0.5  # s between repeated commands
ESCALATE = 1.0  # s without a gateway until emg_stop
HANDED_ON = 1.0  # s from a press until a gateway that is not latched is told of it
NOTED = 10.0  # s from a press until a latch that is shown is on the disk: a gateway that is lost before forgets it


class Act(Enum):
    """The command in place of a gateway."""

    STOP = "cancelled its goals"
    EMERGENCY = "cancelled its goals, emg_stop"


class GatewayStatus(Data):
    """The state of a gateway at one beat."""

    alive: bool  # it has its pulse
    left: bool = False  # it has none because it ended in order
    reported: bool = False  # it has published its state since the last beat
    busy: bool = False  # the machine was last reported to move, or has a goal or a run
    run_lost: bool = False  # the scheduler behind the machine's run is lost, too


class Duty:
    """When to act in place of one gateway, and how."""

    def __init__(self) -> None:
        self.lost_since: float | None = None
        self._watched = False  # a gateway works, or did a moment ago
        self._silent_since: float | None = None
        self._reported, self._emergency, self._again = False, False, 0.0

    def check(self, now: float, status: GatewayStatus) -> Act | None:
        """The command that is due now."""
        if self.lost_since is not None:
            return self._act(now, self.lost_since, status)
        if status.alive:
            self._watched, self._silent_since = True, None
        elif self._watched:
            return self._doubt(now, status)
        return None

    def _doubt(self, now: float, status: GatewayStatus) -> Act | None:
        if status.left:
            self._watched, self._silent_since = False, None
            return Act.STOP
        if self._silent_since is None:
            self._silent_since = now
        if now - self._silent_since < LEASE_MARGIN:
            return None
        self.lost_since, self._silent_since, self._again = now, None, now
        self._reported = self._emergency = False
        return self._act(now, now, status)

    def _act(self, now: float, since: float, status: GatewayStatus) -> Act | None:
        self._reported = self._reported or status.reported
        if status.alive and self._reported:
            self.lost_since = None
            return None
        if not self._emergency and (status.run_lost or (status.busy and now - since >= ESCALATE)):
            self._emergency, self._again = True, now
        if now < self._again:
            return None
        self._again = now + AGAIN
        return Act.EMERGENCY if self._emergency else Act.STOP


class Press:
    """A press of the stop button, until the gateway that shows its latch must have it on the disk, or is re-armed."""

    since: float | None = None
    shown = False  # the present gateway has shown its latch

    def due(self, now: float, alive: bool, latched: bool | None) -> bool:
        """Whether to ask its gateway, which is back, to stop; `latched`: as it shows, None if it shows nothing new."""
        if self.since is None:
            return False
        again = alive and not latched and not self.shown and now - self.since >= HANDED_ON
        over = alive and (now - self.since >= NOTED if latched else latched is False and self.shown)
        self.since = now if again else None if over else self.since
        self.shown = alive and not over and (self.shown or bool(latched))
        return again
