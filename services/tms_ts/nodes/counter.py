"""Count up the number at a key."""

from __future__ import annotations

from tms_reason.reason import Reason
from tms_ts.bt.convert import Missing, text_to_int, to_text
from tms_ts.bt.leaf import SyncAction
from tms_ts.bt.node import Keys
from tms_ts.bt.ports import In
from tms_ts.bt.registry import node
from tms_ts.bt.status import FAILURE, SUCCESS, Status
from tms_ts.tree_reasons import HoldsNoNumber, NumberNotText


@node
class Counter(SyncAction):
    """Add one to the number at a key (kept as text, if it is one; quotes are dropped); fail if there is no number.

    key: the name of the key
    """

    __slots__ = ()
    versions = (5, 6)
    key: In[str]

    def tick(self) -> Status:
        stored = self.blackboard.get(self.key)
        text = to_text(stored)
        number = text if isinstance(text, Missing) else text_to_int(text.removeprefix('"').removesuffix('"'))
        if isinstance(number, Missing):
            self.reason = HoldsNoNumber(self.key)
            return FAILURE
        if isinstance(stored, int) and not isinstance(stored, bool):
            self.warn(NumberNotText(self.key))
            self.store(self.key, number + 1)
        else:
            self.store(self.key, str(number + 1))
        return SUCCESS

    def needed(self) -> list[str]:
        key = self.literal("key")
        return [] if key is None else [key]

    def preflight(self, keys: Keys) -> list[Reason]:
        key = self.literal("key")
        return [NumberNotText(key)] if key is not None and self.number_written(keys, key) else []
