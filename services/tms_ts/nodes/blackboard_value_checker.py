"""Write the value of a key to the log."""

from __future__ import annotations

import structlog

from tms_ts.bt.convert import MISSING
from tms_ts.bt.leaf import SyncAction
from tms_ts.bt.ports import InOut
from tms_ts.bt.registry import node
from tms_ts.bt.status import FAILURE, SUCCESS, Status

log = structlog.stdlib.get_logger(__name__)


@node
class BlackboardValueChecker(SyncAction):
    """Log the value of a key; fail if it has none.

    key: the name of the key
    """

    __slots__ = ()
    key: InOut[str]

    def tick(self) -> Status:
        value = self.blackboard.get(self.key)
        log.info("key=%s value=%r node=%s", self.key, value, self.path)
        return FAILURE if value is MISSING else SUCCESS
