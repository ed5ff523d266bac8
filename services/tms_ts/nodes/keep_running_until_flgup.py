"""Repeat the child until a flag of the blackboard is up."""

from __future__ import annotations

from tms_reason.reason import Reason
from tms_ts.bt.convert import FALSE_WORDS, MISSING, TRUE_WORDS
from tms_ts.bt.decorator import Decorator
from tms_ts.bt.errors import TickError
from tms_ts.bt.node import Keys, Node
from tms_ts.bt.ports import In
from tms_ts.bt.registry import node
from tms_ts.bt.status import FAILURE, IDLE, RUNNING, SUCCESS, Status
from tms_ts.tree_reasons import KeyNotBoolean, OneRoundMore, RunsUntil, StoredTextThrows, TextAsBoolean

WHILE = ("While", "while")


@node
class KeepRunningUntilFlgup(Decorator):
    """Run the child again and again until a key is true; fail when the child fails.

    key: the name of the key
    while_or_dowhile: (version 6) While or while: look at the key before the child, too; else after it only
    """

    __slots__ = ()
    versions = (5, 6)
    key: In[str]
    while_or_dowhile: In[str]

    def endless(self) -> bool:
        return True

    def tick(self) -> Status:
        key: str = self.key
        self.set_state(RUNNING)
        if self.read("while_or_dowhile") in WHILE and self.flag(key):
            self.child.reset()
            return SUCCESS
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

    def preflight(self, keys: Keys) -> list[Reason]:
        key, mode = self.literal("key"), self.literal("while_or_dowhile")
        if key is None:
            return []
        writer = keys.writers.get(self.blackboard.place(key))
        late = mode is not None and mode not in WHILE and writer is not None and self.is_above(writer)
        notes: list[Reason] = [OneRoundMore(key)] if late else []
        return [*notes, StoredTextThrows(keys.texts[key], key)] if key in keys.texts else notes

    def is_above(self, node: Node) -> bool:
        above = node.parent
        while above is not None and above is not self:
            above = above.parent
        return above is self

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
