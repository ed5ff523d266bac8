"""Defences against the same: a defect of one is looked for without the others."""

from collections.abc import Callable, Mapping
from typing import Any

from simulation.disk import Notes
from simulation.scheduler import Scheduler
from tms_proof.following import Follower

Switch = Callable[[Any, str, Any], None]

WITHOUT: Mapping[str, tuple[Any, str, Any]] = {
    "the host agent's note of a press": (Notes, "press", lambda *_: None),
    "the place that a goal must have reached": (Follower, "behind", lambda *_: {}),
    "the scheduler's handing on of a press": (Scheduler, "hand_on", lambda *_: None),
}


def put_out(name: str, switch: Switch = setattr) -> None:
    """Put a defence out of action, in this process; `switch` may be that of a test, which ends with it."""
    switch(*WITHOUT[name])
