"""Documents of BehaviorTree.CPP v4: elements with the same meaning are translated, others are refused by name."""

from __future__ import annotations

from tms_reason.reason import Reason
from tms_ts.tree_reasons import V4Json, V4Node, V4RootBlackboard, V4Script, V4SharedBlackboard

SCRIPTS = frozenset({"_skipIf", "_failureIf", "_successIf", "_while", "_onSuccess", "_onFailure", "_onHalted", "_post"})
V4_NODES = frozenset({
    "AsyncSequence", "AsyncFallback", "RunOnce", "Precondition", "LoopInt", "LoopDouble", "LoopBool", "LoopString",
    "Sleep", "UnsetBlackboard", "WasEntryUpdated", "SkipUnlessUpdated", "WaitValueUpdate", "TryCatch", "Script",
    "ScriptCondition", "ParallelAll", "SequenceWithMemory", "EntryUpdatedAction", "EntryUpdatedDecorator",
})  # fmt: skip
RENAMED_NODES = {"SequenceWithMemory": "SequenceStar"}
RENAMED_PORTS = {"Parallel": {"success_count": "success_threshold", "failure_count": "failure_threshold"}}


def feature(name: str, attributes: dict[str, str], *, v4: bool) -> Reason | None:
    """The feature of v4 that an element uses and that this engine does not have."""
    if name in V4_NODES and not (v4 and name in RENAMED_NODES):
        return V4Node(name)
    for key, value in attributes.items():
        if key in SCRIPTS:
            return V4Script(key)
        if v4 and value.startswith("{@"):
            return V4RootBlackboard(key, value)
        if v4 and value.startswith("json:"):
            return V4Json(key, value)
    if v4 and "__shared_blackboard" in attributes:
        return V4SharedBlackboard()
    return None


def translated(name: str, attributes: dict[str, str]) -> tuple[str, dict[str, str]]:
    """Name and attributes of a v4 element, as v3 writes them."""
    ports = RENAMED_PORTS.get(name, {})
    attributes = {ports.get(key, key): value for key, value in attributes.items()}
    if name == "Parallel":
        attributes.setdefault("success_threshold", "-1")
    if name == "SubTree":
        name = "SubTreePlus"
        if "_autoremap" in attributes:
            attributes["__autoremap"] = attributes.pop("_autoremap")
    return RENAMED_NODES.get(name, name), attributes
