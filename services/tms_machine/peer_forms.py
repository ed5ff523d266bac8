"""The forms of definitions that the C++ system's versions have under one name of DDS.

DDS connects nodes of different forms, and the receiver of a goal misreads it without an error: a process of version 5
that gets a goal of version 6 loses its inputs, and would move the machine in another way. Nodes of Jazzy tell the hash
of their form; those of Humble tell none, and the site file says which form they speak.
"""

from typing import Any

from tms_machine.reasons import FormContradicted, FormUnknown
from tms_reason.reason import Reason
from tms_ros.node import Ros
from tms_runtime.graph import node_of

# Hashes of the requests of SendGoal: of all parts of these actions, only the goal differs (tests/contract).
HASHES = {
    "LeafNodeBase": {
        "v5": "RIHS01_5ea73efcc195590b6b42927f3bae314bef66e5c114ffcdbc2cf376bfc162ea57",
        "v6a": "RIHS01_aed5d0e8543536c6b433b9bbe25f8324768feef5fd4f783d9be919a27d449b1c",
        "v6b": "RIHS01_4b03e5a8da19003e63945ca1c6b0415065324d85834568a8642453dd4be672c2",
    },
    "TmsRpExcavator": {
        "plan": "RIHS01_7af63a37786773d183ecf4dd17fe461811704d3ee525babada297c6ad544511f",
        "plans": "RIHS01_082205717a1c21796cc57dd7f49af6937cc69af2aaf19fe2401dfb508c1486c0",
    },
}
USUAL = {"LeafNodeBase": "v5"}  # the form of a definition where the site file declares none


def misfit(ros: Ros, machine: str, action: str, definition: str, declared: str, *, servers: bool) -> Reason | None:
    """Why a server, or a client, of another system's action of a machine would be misunderstood.

    `declared`: its form by the site file, empty where none is.
    """
    node = ros.node
    look = node.get_subscriptions_info_by_topic if servers else node.get_publishers_info_by_topic
    for end in look(f"rq/{machine}/{action}/_action/send_goalRequest", no_mangle=True):
        if node_of(end) != node.get_fully_qualified_name():
            why = judged(end.topic_type_hash, node_of(end), machine, definition, declared)
            if why is not None:
                return why
    return None


def judged(told: Any, node: str, machine: str, definition: str, declared: str) -> Reason | None:
    """Why a node is refused that tells this hash."""
    if not str(told).startswith("RIHS01_"):
        return None if declared else FormUnknown(node, definition, machine)
    expected, known = declared or USUAL[definition], {text: form for form, text in HASHES[definition].items()}
    found = known.get(str(told), "?")
    return None if found == expected else FormContradicted(node, definition, found, expected, machine)
