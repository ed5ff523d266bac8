"""Whether a machine gets on, as the progress checkers of the machines' navigation judge it. Pure logic."""

from tms_control.path import Pose

MOVED, TURNED, PATIENCE = 0.5, 0.3, 10.0  # m or rad within s: figures of the real ic120's navigation, its turn ours


class Progress:
    """Remembers where the machine was when it last got on."""

    def __init__(self) -> None:
        self._mark: tuple[float, Pose] | None = None  # s of the machine

    def restart(self) -> None:
        """Begin anew: it has stood for a reason."""
        self._mark = None

    def lacks(self, now: float, pose: Pose) -> bool:
        """Whether it has not got on for too long."""
        if self._mark is None:
            self._mark = now, pose
        since, mark = self._mark
        if pose.away(mark) >= MOVED or abs(mark.off(pose.yaw)) >= TURNED:
            self._mark = now, pose
            return False
        return now - since >= PATIENCE
