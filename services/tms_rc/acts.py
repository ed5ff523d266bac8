"""What persons did at this gateway past the console, for the audit that `tms:ur` keeps; it may be away meanwhile."""

from tms_msg_db.msg import Event

from tms_machine import stamps
from tms_runtime.app import App

KEPT = 20  # of one gateway, for a console that comes later


class Acts:
    """The topic `/<machine>/rc/acts`."""

    def __init__(self, app: App) -> None:
        self._publisher = app.ros.publisher(Event, f"/{app.machine}/rc/acts", depth=KEPT, latched=True)

    def tell(self, what: str, target: str, who: str, at: float) -> None:
        """Tell of an act that was done at a time [s since 1970]; the audit takes the same act once."""
        self._publisher.publish(Event(stamp=stamps.time(at), kind=what, node=target, text=who))
