"""Fencing numbers: which run, leaf and process a goal comes from, as the goal's UUID says it.

The client of an action chooses the UUID. So the types on the wire stay unchanged, and the gateway can distinguish
goals of the present run from late goals of an abandoned run.
"""

from dataclasses import replace
from functools import lru_cache

from tms_decision.data import Data

MAGIC = b"TMS\x01"  # a random UUID of a foreign client starts like this once in 4 billion
LEAVES = 0xFFFF  # leaf goals are counted modulo this


class Owner(Data):
    """Where a goal comes from: run number, leaf goal of that run, processes between scheduler and here."""

    run: int
    leaf: int = 0
    hop: int = 0

    def goal_id(self, tail: bytes) -> bytes:
        """The UUID of a goal of this owner; `tail`: 3 bytes that no other goal of this owner has."""
        return MAGIC + self.run.to_bytes(6, "big") + self.leaf.to_bytes(2, "big") + bytes([self.hop]) + tail

    def next(self) -> "Owner":
        """The owner of goals that the server of this owner's goal sends on."""
        return replace(self, hop=self.hop + 1)


@lru_cache(maxsize=64)
def parse(goal_id: bytes) -> Owner | None:
    """The owner in a goal's UUID; None for a foreign client's goal."""
    if len(goal_id) != 16 or not goal_id.startswith(MAGIC):
        return None
    return Owner(int.from_bytes(goal_id[4:10], "big"), int.from_bytes(goal_id[10:12], "big"), goal_id[12])
