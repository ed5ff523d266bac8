"""Repeat the child until a flag of the blackboard is up."""

from __future__ import annotations

from collections.abc import Mapping

from tms_reason.reason import Reason
from tms_ts.bt.convert import FALSE_WORDS, MISSING, TRUE_WORDS
from tms_ts.bt.decorator import Decorator
from tms_ts.bt.errors import TickError
from tms_ts.bt.ports import In
from tms_ts.bt.reasons import KeyNotBoolean, RunsUntil, StoredTextThrows, TextAsBoolean
from tms_ts.bt.registry import node
from tms_ts.bt.status import FAILURE, IDLE, RUNNING, SUCCESS, Status


@node
class KeepRunningUntilFlgup(Decorator):
    """Run the child again and again until a key is true; fail when the child fails.

    key: the name of the key
    """

    __slots__ = ()
    key: In[str]

    def endless(self) -> bool:
        return True

    def tick(self) -> Status:
        key: str = self.key
        self.set_state(RUNNING)
        status = self.child.execute_tick()
        if status is IDLE:
            raise self.never_idle()
        if status is RUNNING:
            return RUNNING
        self.child.reset()
        if status is FAILURE:
            return FAILURE
        self.reason = RunsUntil(key)
        return SUCCESS if self.flag(key) else RUNNING

    def preflight(self, texts: Mapping[str, str]) -> list[Reason]:
        key = self.literal("key")
        if key is None or key not in texts:
            return []
        return [StoredTextThrows(texts[key], key)]

    def flag(self, key: str) -> bool:
        value = self.blackboard.get(key)
        if value is MISSING:
            return False
        if isinstance(value, str) and value in TRUE_WORDS | FALSE_WORDS:
            self.warn(TextAsBoolean(key, value))
            return value in TRUE_WORDS
        if not isinstance(value, bool):
            raise TickError(KeyNotBoolean(key, str(value)))
        return value
