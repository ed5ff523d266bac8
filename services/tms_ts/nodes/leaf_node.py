"""The leaf of version 5 of the C++ system; each machine model has a subclass, with its name and its ports."""

from __future__ import annotations

from tms_ts.bt.ports import In
from tms_ts.bt.registry import generic
from tms_ts.nodes.machine_leaf import MachineLeaf


@generic
class LeafNode(MachineLeaf):
    """Let a machine do a subtask with the parameters of a record.

    model_name: the machine, e.g. zx200
    record_name: the record of parameters, as text or {key}
    subtask_name: the subtask, e.g. st_zx200_follow_waypoints
    """

    __slots__ = ()
    required = frozenset({"model_name", "subtask_name"})
    needs = ("record_name",)
    subtask_port = "subtask_name"
    model_name: In[str]
    record_name: In[str]
    subtask_name: In[str]

    def record(self) -> str:
        name: str = self.record_name
        return name

    def record_reported(self) -> str:
        return self.reported("record_name")
