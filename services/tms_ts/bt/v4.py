"""Documents of BehaviorTree.CPP v4: what means the same here is translated, the rest is refused by name."""

from __future__ import annotations

SCRIPTS = frozenset({"_skipIf", "_failureIf", "_successIf", "_while", "_onSuccess", "_onFailure", "_onHalted", "_post"})
V4_NODES = frozenset({
    "AsyncSequence", "AsyncFallback", "RunOnce", "Precondition", "LoopInt", "LoopDouble", "LoopBool", "LoopString",
    "Sleep", "UnsetBlackboard", "WasEntryUpdated", "SkipUnlessUpdated", "WaitValueUpdate", "TryCatch", "Script",
    "ScriptCondition", "ParallelAll", "SequenceWithMemory", "EntryUpdatedAction", "EntryUpdatedDecorator",
})  # fmt: skip
RENAMED_NODES = {"SequenceWithMemory": "SequenceStar"}
RENAMED_PORTS = {"Parallel": {"success_count": "success_threshold", "failure_count": "failure_threshold"}}


def feature(name: str, attributes: dict[str, str], *, v4: bool) -> str:
    """The v4 feature that an element uses and that has no like here; empty if there is none."""
    if name in V4_NODES and not (v4 and name in RENAMED_NODES):
        return f"<{name}> is a node of BehaviorTree.CPP v4"
    for key, value in attributes.items():
        if key in SCRIPTS:
            return f"the script attribute {key!r} is a feature of BehaviorTree.CPP v4"
        if v4 and value.startswith("{@"):
            return f"{key}={value!r}: the root blackboard is a feature of BehaviorTree.CPP v4"
        if v4 and value.startswith("json:"):
            return f"{key}={value!r}: json values are a feature of BehaviorTree.CPP v4"
    if v4 and "__shared_blackboard" in attributes:
        return "__shared_blackboard does not exist in a document of BehaviorTree.CPP v4"
    return ""


def translated(name: str, attributes: dict[str, str]) -> tuple[str, dict[str, str]]:
    """Name and attributes of a v4 element in the words of v3."""
    ports = RENAMED_PORTS.get(name, {})
    attributes = {ports.get(key, key): value for key, value in attributes.items()}
    if name == "Parallel":
        attributes.setdefault("success_threshold", "-1")
    if name == "SubTree":
        name = "SubTreePlus"
        if "_autoremap" in attributes:
            attributes["__autoremap"] = attributes.pop("_autoremap")
    return RENAMED_NODES.get(name, name), attributes
