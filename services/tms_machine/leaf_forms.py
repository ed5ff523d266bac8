"""The forms of LeafNodeBase, which the C++ system's versions have under one name of DDS.

DDS connects nodes of different forms, and the receiver of a goal misreads it without an error: a process of version 5
that gets a goal of version 6 loses its inputs, and would move the machine in another way. Nodes of Jazzy tell the hash
of their form; those of Humble tell none, and the site file says which form they speak (`peers:`).
"""

from typing import Any, cast

from tms_msg_if.action import LeafGoal
from tms_msg_ts.action import LeafNodeBase

from tms_config.config import Site
from tms_config.naming import LEAF_GOAL
from tms_machine.reasons import FormContradicted, FormUnknown
from tms_reason.reason import Reason
from tms_ros.interface_types import ActionType
from tms_ros.node import Ros, node_of

USUAL = "v5"  # the form that our own processes speak
# Hashes of LeafNodeBase_SendGoal_Request: of all parts of the action, only the goal differs (tests/contract).
HASHES = {
    "v5": "RIHS01_5ea73efcc195590b6b42927f3bae314bef66e5c114ffcdbc2cf376bfc162ea57",
    "v6a": "RIHS01_aed5d0e8543536c6b433b9bbe25f8324768feef5fd4f783d9be919a27d449b1c",
    "v6b": "RIHS01_4b03e5a8da19003e63945ca1c6b0415065324d85834568a8642453dd4be672c2",
}
LeafAction = ActionType[LeafNodeBase.Goal, LeafNodeBase.Result, LeafNodeBase.Feedback]


def own_action(site: Site, machine: str, subtask: str) -> tuple[LeafAction, str]:
    """Type and name of a subtask's action within this system.

    Where peers of version 6 share the machine's names, these names are for them: `<machine>:if` serves them there.
    """
    if site.other_form(machine):
        return cast(LeafAction, LeafGoal), f"/{machine}/{subtask}/{LEAF_GOAL}"  # its parts have the same fields
    return LeafNodeBase, f"/{machine}/{subtask}"


def misfit(ros: Ros, site: Site, machine: str, subtask: str, *, servers: bool) -> Reason | None:
    """Why a server, or a client, of another system's leaf action on these names would be misunderstood."""
    peer = site.file.peers.get(machine)
    node = ros.node
    look = node.get_subscriptions_info_by_topic if servers else node.get_publishers_info_by_topic
    for end in look(f"rq/{machine}/{subtask}/_action/send_goalRequest", no_mangle=True):
        if node_of(end) != node.get_fully_qualified_name():
            why = judged(end.topic_type_hash, node_of(end), machine, peer.leaf if peer else "")
            if why is not None:
                return why
    return None


def judged(told: Any, node: str, machine: str, declared: str) -> Reason | None:
    """Why a node is refused that tells this hash; `declared`: its form by the site file, empty where none is."""
    if not str(told).startswith("RIHS01_"):
        return None if declared else FormUnknown(node, machine)
    if str(told) == HASHES[declared or USUAL]:
        return None
    known = {text: form for form, text in HASHES.items()}
    return FormContradicted(node, known.get(str(told), "?"), declared or USUAL, machine)
