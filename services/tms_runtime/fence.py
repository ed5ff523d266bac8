"""New UUIDs for goals, with their fencing numbers; of foreign clients with all but the tail of the first goal's."""

import secrets

from tms_decision.owner import Owner, parse

TAIL = 3  # bytes


def goal_id(owner: Owner) -> bytes:
    """A new UUID for a goal of an owner."""
    return owner.goal_id(secrets.token_bytes(TAIL))


def derived(uuid: bytes) -> bytes | None:
    """UUID for a goal that is sent on behalf of goal `uuid`; None (a random one) beyond the last hop."""
    owner = parse(uuid)
    if owner is None:
        return uuid[:-TAIL] + secrets.token_bytes(TAIL)
    return None if owner.hop >= 255 else goal_id(owner.next())


def same_client(uuid: bytes, other: bytes) -> bool:
    """Whether two goals of foreign clients were asked for by one goal, or are it."""
    return parse(uuid) is None and uuid[:-TAIL] == other[:-TAIL]
