"""The states of a run, as its history shows them."""

from tms_reason.reason import Reason
from tms_ts.reasons import (
    StateAbandoned,
    StateBecause,
    StateCancelled,
    StateFailure,
    StateInterrupted,
    StatePreparing,
    StateRefused,
    StateRunning,
    StateStopping,
    StateStopUnconfirmed,
    StateSuccess,
)

STATES: dict[str, Reason] = {
    "preparing": StatePreparing(), "running": StateRunning(), "stopping": StateStopping(),
    "success": StateSuccess(), "failure": StateFailure(), "cancelled": StateCancelled(),
    "stop_unconfirmed": StateStopUnconfirmed(), "interrupted": StateInterrupted(), "refused": StateRefused(),
    "abandoned": StateAbandoned(),
}  # fmt: skip


def entered(state: str, why: Reason | None) -> Reason:
    """The reason that says which state a run has entered, and why."""
    return STATES[state] if why is None else StateBecause(STATES[state], why)
