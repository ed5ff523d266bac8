"""The mode that a machine's lamps show to people around it."""

from typing import Literal

Mode = Literal["automatic", "manual", "stopped", "fault"]


def mode(by_hand: bool, armed: bool, ready: bool) -> Mode:
    """Which one: in a person's hands, stopped until a person or its run goes on, not able to work, or about to move."""
    if by_hand:
        return "manual"
    if not armed:
        return "stopped"
    return "automatic" if ready else "fault"
