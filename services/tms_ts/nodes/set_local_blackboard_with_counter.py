"""Put a counter's value at the end of a text: pose_0 and 2 make pose_2."""

from __future__ import annotations

import re

from tms_ts.bt.convert import Missing, to_text
from tms_ts.bt.leaf import SyncAction
from tms_ts.bt.ports import In, InOut
from tms_ts.bt.registry import node
from tms_ts.bt.status import FAILURE, SUCCESS, Status
from tms_ts.tree_reasons import NoValue


@node
class SetLocalBlackboardWithCounter(SyncAction):
    """Replace the digits at the end of the text at a key by the text at the counter's key.

    key: the key of the text
    counter_key: the key of the counter
    """

    __slots__ = ()
    versions = (5, 6)
    key: In[str]
    counter_key: InOut[str]

    def tick(self) -> Status:
        text = to_text(self.blackboard.get(self.key))
        counter = to_text(self.blackboard.get(self.counter_key))
        if isinstance(text, Missing) or isinstance(counter, Missing):
            self.reason = NoValue(self.key, self.counter_key)
            return FAILURE
        self.store(self.key, re.sub(r"[0-9]+\Z", lambda _: counter, text))
        return SUCCESS

    def needed(self) -> list[str]:
        keys = (self.literal("key"), self.literal("counter_key"))
        return [key for key in keys if key is not None]
