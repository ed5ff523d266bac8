"""The leaf actions of a machine, where peers speak LeafNodeBase in other forms than our own processes, version 5's."""

from typing import cast

from tms_msg_if.action import LeafGoal
from tms_msg_ts.action import LeafNodeBase

from tms_config.config import Site
from tms_config.naming import LEAF_GOAL
from tms_interfaces.generated import ActionType
from tms_machine import peer_forms
from tms_reason.reason import Reason
from tms_ros.node import Ros

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
    return peer_forms.misfit(ros, machine, subtask, "LeafNodeBase", peer.leaf if peer else "", servers=servers)
