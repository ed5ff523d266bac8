"""Finds the process behind a ROS name, as `tms ps` lists it: people restart processes, not services."""

OF_GATEWAY = ("rc", "rearm", "take")
LEAF_GOAL = "leaf_goal"  # end of a subtask's own name where its usual one is for peers (tms_machine/leaf_forms.py)


def process_of(name: str) -> str:
    """`/tms/db/get_task` -> `tms:db`, `/zx200/rc/stop` -> `zx200:rc`; for its own controllers, the machine."""
    parts = name.strip("/").split("/")
    if len(parts) < 2:
        return parts[0]
    owner, first = parts[0], parts[1]
    if owner == "tms":
        return f"tms:{first}" if len(parts) > 2 else "tms:ts"
    if first in OF_GATEWAY:
        return f"{owner}:rc"
    if first == "request_wait_ur":
        return "tms:ts"
    if first.startswith("tms_rp_"):
        return f"{owner}:rp"
    return f"{owner}:{first}" if len(parts) == 2 or parts[2] == LEAF_GOAL else owner
