"""Ask whether any record holds given values; an early form of MongoValueSearcher."""

from __future__ import annotations

import re

from tms_reason.reason import Reason
from tms_ts.bt.convert import Missing
from tms_ts.bt.node import Keys
from tms_ts.bt.ports import Pointer
from tms_ts.bt.registry import node
from tms_ts.nodes.mongo_value_searcher import MongoValueSearcher, parts
from tms_ts.nodes.shared_value import keys_named, referred, typed
from tms_ts.tree_reasons import AllBraces
from tms_ts.world import Value

_KEY = re.compile(r"\{(.+)\}", re.DOTALL)


@node
class BlackboardValueSearcherMongo(MongoValueSearcher):
    """Store whether a record of any machine has all given values, then succeed; an early MongoValueSearcher.

    mongo_value: a value for each, with commas: true, false, a number, a text, a "text" in quotes, or that of a {key}
    """

    __slots__ = ()

    def wanted_text(self) -> str:
        bound = self.bindings.get("mongo_value")
        return bound.text if isinstance(bound, Pointer) else super().wanted_text()

    def wanted(self, text: str) -> Value | Missing:
        found = referred(self, text, _KEY)
        return typed(text) if found is None else found

    def needed(self) -> list[str]:
        bound = self.bindings.get("mongo_value", "")
        return keys_named(*parts(bound.text if isinstance(bound, Pointer) else bound), form=_KEY)

    def preflight(self, keys: Keys) -> list[Reason]:
        bound = self.bindings.get("mongo_value")
        if isinstance(bound, Pointer) and "," in bound.key:
            return [AllBraces("mongo_value", bound.text)]
        return super().preflight(keys)
