"""A goal whose server is gone never ends by itself: the machine is stopped, and the goal given up."""

from types import SimpleNamespace
from typing import Any

from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_machine.border import MOTIONS
from tms_rc.active import Active, StopKind
from tms_rc.gateway import Gateway
from tms_rc.reasons import ControllerLeft
from tms_reason.reason import Reason
from tms_ros.reasons import ProcessLost

MODEL = parse(CONFIGS / "machines" / "ic120.yaml", MachineModel)


class Peer:
    """Its server leaves, while the machine itself is heard."""

    name = "/ic120/navigate_to_pose"

    def __init__(self) -> None:
        self.looks = self.given_up = 0

    def left(self) -> bool:
        self.looks += 1
        return self.looks > 2

    def mark_lost(self) -> None:
        self.given_up += 1


def test_a_server_that_leaves_during_a_drive_stops_the_machine() -> None:
    stops: list[tuple[Reason, StopKind]] = []
    gateway: Any = Gateway.__new__(Gateway)
    gateway._app = SimpleNamespace(machine="ic120")
    gateway._model, gateway._watch = MODEL, SimpleNamespace(positions={}, trouble=lambda now: None)
    gateway._begin = lambda motion, active, now: None
    gateway._guard = SimpleNamespace(stop=lambda cause, kind: stops.append((cause, kind)), silent=lambda: None)
    peer: Any = Peer()
    goal: Any = SimpleNamespace(request=SimpleNamespace())
    active = Active(goal, None, peer, {}, {}, call=SimpleNamespace(accepted=True, outcome=None))  # type: ignore[arg-type]
    gateway._watch_motion(MOTIONS[1], active)
    assert stops == [(ProcessLost(ControllerLeft("ic120", "/ic120/navigate_to_pose")), StopKind.PLAIN)]
    assert peer.given_up == 1
