"""What the disk must know before a goal leaves, before the machine counts as armed, and before a receipt is told."""

from tms_decision.gateway.effects import KeepDriver, KeepState
from tms_decision.gateway.events import NoteKept
from tms_decision.gateway.state import Gateway


def keep(gateway: Gateway, armed: bool = False) -> int:
    """Write the state, `armed`: after a re-arm; returns the number of its note, 0 if the disk has it already."""
    notes, latch = gateway.notes, gateway.latch
    arms = armed or any(one.note and one.closings == latch.closings for one in gateway.rearms)  # it waits for its note
    state = (None if arms else latch.cause, notes.holder, notes.run)
    if state == notes.asked:
        return notes.number if notes.number > notes.kept else 0
    notes.asked = state
    notes.number += 1
    gateway.do(KeepState(notes.number, *state))
    return notes.number


def hold(gateway: Gateway, holder: str, run: int, armed: bool = False) -> int:
    """Write who may move the machine from now on (empty: no run); returns as `keep`."""
    gateway.notes.holder, gateway.notes.run = holder, run
    return keep(gateway, armed)


def drive(gateway: Gateway, who: str) -> int:
    """Write who drives by hand; returns the number of the note."""
    gateway.notes.number += 1
    gateway.do(KeepDriver(gateway.notes.number, who))
    return gateway.notes.number


def kept(gateway: Gateway, event: NoteKept) -> None:
    """The disk has answered; a state that it has not taken is written again with the next one."""
    gateway.notes.kept = event.number
    if event.problem is not None:
        gateway.notes.asked = None
