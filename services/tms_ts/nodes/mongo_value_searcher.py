"""Ask whether any record holds given values."""

from __future__ import annotations

from tms_reason.reason import Reason
from tms_ts.bt.convert import Missing
from tms_ts.bt.errors import TickError
from tms_ts.bt.node import Keys
from tms_ts.bt.ports import In, Out, Pointer
from tms_ts.bt.registry import node
from tms_ts.bt.status import SUCCESS, Status
from tms_ts.nodes.asking import Asking
from tms_ts.nodes.shared_value import keys_named, referred, typed
from tms_ts.tree_reasons import AlwaysFails, OutputNotConnected, UnevenLists
from tms_ts.world import Pending, Value


@node
class MongoValueSearcher(Asking):
    r"""Store whether a record of any machine has all given values, then succeed.

    mongo_param_name: the fields, with commas between them
    mongo_value: a value for each, with commas: true, false, a number, a text, a "text" in quotes, or that of a \key\
    output_port: the key to write: true if there is such a record, else false
    """

    __slots__ = ()
    versions = (6,)
    needs = ("output_port", "mongo_param_name", "mongo_value")
    output_port: Out[bool]
    mongo_param_name: In[str]
    mongo_value: In[str]

    def wanted_text(self) -> str:
        """The list of values as the document has it, or the text of a key."""
        text: str = self.mongo_value
        return text

    def wanted(self, text: str) -> Value | Missing:
        """One value of the list; MISSING fails the node, whose reason is set."""
        found = referred(self, text)
        return typed(text) if found is None else found

    def ask(self) -> Pending[bool] | None:
        if "output_port" not in self.bindings:
            raise TickError(OutputNotConnected(self.registration_name, "output_port"))
        names, texts = self.mongo_param_name.split(","), parts(self.wanted_text())
        if len(names) != len(texts):
            self.reason = UnevenLists(len(names), len(texts))
            return None
        values = {}
        for name, text in zip(names, texts, strict=True):
            value = self.wanted(text)
            if isinstance(value, Missing):
                return None
            values[name] = value
        return self.world.flags.find(values)

    def answered(self, value: bool) -> Status:
        bound = self.bindings["output_port"]
        self.store(bound.key if isinstance(bound, Pointer) else bound, value)
        return SUCCESS

    def needed(self) -> list[str]:
        return keys_named(*parts(self.literal("mongo_value") or ""))

    def preflight(self, keys: Keys) -> list[Reason]:
        names, values = self.literal("mongo_param_name"), self.literal("mongo_value")
        if names is None or values is None or len(names.split(",")) == len(parts(values)):
            return []
        return [AlwaysFails(UnevenLists(len(names.split(",")), len(parts(values))), self.registration_name)]


def parts(text: str) -> list[str]:
    """The values of a list; a = before the first one says nothing."""
    return text.removeprefix("=").split(",")
