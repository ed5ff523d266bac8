"""Fencing numbers: the goal's UUID says which run, leaf and process the goal comes from.

The client of an action chooses the UUID. So the types on the wire stay unchanged, and the gateway can distinguish
goals of the present run from late goals of an abandoned run. Pure logic.
"""

import secrets
from dataclasses import dataclass, replace

MAGIC = b"TMS\x01"  # a random UUID of a foreign client starts like this once in 4 billion
LEAVES = 0xFFFF  # leaf goals are counted modulo this


@dataclass(frozen=True)
class Owner:
    """Where a goal comes from: run number, leaf goal of that run, processes between scheduler and here."""

    run: int
    leaf: int = 0
    hop: int = 0

    def goal_id(self) -> bytes:
        """A new UUID for a goal of this owner."""
        head = MAGIC + self.run.to_bytes(6, "big") + self.leaf.to_bytes(2, "big") + bytes([self.hop])
        return head + secrets.token_bytes(3)

    def next(self) -> "Owner":
        """The owner of goals that the server of this owner's goal sends on."""
        return replace(self, hop=self.hop + 1)


def parse(goal_id: bytes) -> Owner | None:
    """The owner in a goal's UUID; None for a foreign client's goal."""
    if len(goal_id) != 16 or not goal_id.startswith(MAGIC):
        return None
    return Owner(int.from_bytes(goal_id[4:10], "big"), int.from_bytes(goal_id[10:12], "big"), goal_id[12])


def derived(goal_id: bytes) -> bytes | None:
    """UUID for a goal that is sent on behalf of `goal_id`; None (a random one) for foreign goals."""
    owner = parse(goal_id)
    return None if owner is None or owner.hop >= 255 else owner.next().goal_id()
