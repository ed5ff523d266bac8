"""New UUIDs for goals, with their fencing numbers."""

import secrets

from tms_decision.owner import Owner, parse

TAIL = 3  # bytes


def goal_id(owner: Owner) -> bytes:
    """A new UUID for a goal of an owner."""
    return owner.goal_id(secrets.token_bytes(TAIL))


def derived(uuid: bytes) -> bytes | None:
    """UUID for a goal that is sent on behalf of goal `uuid`; None (a random one) for foreign goals."""
    owner = parse(uuid)
    return None if owner is None or owner.hop >= 255 else goal_id(owner.next())
