"""The scheduler's permit for one machine.

Where a site has several schedulers, a writer is there only while a run of its scheduler needs it: a gateway that starts
gets the last message of every writer, in any order, and one that stands behind nothing must not come last.
"""

import threading
from collections.abc import Callable

from tms_machine.permit import Permit
from tms_ros.node import Ros

LINGERS = 2.0  # s for the last message to arrive


class RunPermit:
    """Any thread may call."""

    def __init__(self, ros: Ros, make: Callable[[], Permit], several: bool) -> None:
        self._ros, self._make, self._several = ros, make, several
        self._permit = None if several else make()
        self._holds = False
        self._lock = threading.Lock()  # held for moments only

    def hold(self, goal: bytes, run_id: str) -> None:
        """Stand behind a run from now on."""
        with self._lock:
            self._holds = True
            self._permit = self._permit or self._make()
            self._permit.hold(goal, run_id)

    def drop(self) -> None:
        """The run is over."""
        with self._lock:
            self._holds = False
            if self._permit is not None:
                self._permit.drop()
        if self._several:
            self._ros.on_executor(lambda: self._ros.after(LINGERS, self._leave))

    def _leave(self) -> None:
        with self._lock:
            if not self._holds and self._permit is not None:
                self._permit.end()
                self._permit = None
