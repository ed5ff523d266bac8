"""The leaf of version 6 of the C++ system; each kind of machine has a subclass, with its ports."""

from __future__ import annotations

from tms_machine.goal_inputs import KINDS, joined
from tms_reason.reason import Reason
from tms_ts.bt.convert import MISSING, convert
from tms_ts.bt.node import Keys
from tms_ts.bt.ports import In
from tms_ts.bt.registry import generic
from tms_ts.nodes.machine_leaf import MachineLeaf
from tms_ts.tree_reasons import AlwaysFails, MissingParameter


@generic
class PrimitiveLeaf(MachineLeaf):
    """Let a machine do a primitive with the parameters of a record; fail if the record is not given.

    model_name: the machine, e.g. zx200
    primitive_name: the primitive, e.g. primitive_crawlerdump_follow_waypoints
    record_name: the record of parameters, as text or {key}
    """

    __slots__ = ()
    versions = (6,)
    required = frozenset({"model_name", "primitive_name"})
    subtask_port = "primitive_name"
    model_name: In[str]
    record_name: In[str]
    primitive_name: In[str]

    def record(self) -> str | None:
        given = [value for port in self.record_ports if (value := self.read(port)) is not MISSING]
        if not given:
            self.reason = MissingParameter(self.registration_name, self.record_ports[0])
            return None
        return joined(next(filter(None, given), ""), self.inputs_given())  # Groot writes empty ports, too

    def inputs_given(self) -> dict[str, str | bool]:
        """Inputs of the goal: without those that are empty or false, which the C++ system sends as if not given."""
        found = {name: convert(self.read(name), kind) for name, kind in KINDS.items() if name in self.ports}
        return {name: value for name, value in found.items() if value not in (MISSING, "", False)}

    def record_reported(self) -> str:
        record = next(filter(None, map(self.reported, self.record_ports)), "")
        inputs = {name: self.reported(name) for name in KINDS if name in self.ports}
        known = {name: text for name, text in inputs.items() if text not in ("", "false")}
        return joined(record, known)

    def preflight(self, keys: Keys) -> list[Reason]:
        if any(port in self.bindings for port in self.record_ports):
            return super().preflight(keys)
        missing = MissingParameter(self.registration_name, self.record_ports[0])
        return [*super().preflight(keys), AlwaysFails(missing, self.registration_name)]
