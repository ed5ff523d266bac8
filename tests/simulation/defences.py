"""Defences against the same: a defect of one is looked for without the others."""

from collections.abc import Callable, Mapping
from typing import Any

from simulation import execution
from simulation.disk import Notes
from tms_decision.duty import Press
from tms_proof.following import Follower

Switch = Callable[[Any, str, Any], None]

WITHOUT: Mapping[str, tuple[Any, str, Any]] = {
    "the host agent's note of a press": (Notes, "press", lambda *_: None),
    "the host agent's handing on of a press": (Press, "due", lambda *_, **__: False),
    "the place that a goal must have reached": (Follower, "behind", lambda *_: {}),
    "the scheduler's stop after a press": (execution, "_missed_press", execution._end_of_run),
}


def put_out(name: str, switch: Switch = setattr) -> None:
    """Put a defence out of action, in this process; `switch` may be that of a test, which ends with it."""
    switch(*WITHOUT[name])
