"""A node as this system uses it: calls are safe from any thread."""

import time
from collections.abc import Callable

from tms_ros.client import AnyPeer, Peer
from tms_ros.goals import Accept, Ended
from tms_ros.interface_types import ActionType, F, G, R
from tms_ros.server import Goal, Served
from tms_ros.services import Services

STOP_LIMIT = 1.0  # s for the workers of served goals to stop their motions
LAST_WORDS = 0.1  # s for results and reasons to leave before this process does


class Ros(Services):
    """One node: its thread and times (loop.py), topics, services, and here its actions."""

    def __init__(self, name: str, namespace: str = "/", process: str = "") -> None:
        super().__init__(name, namespace, process)
        self._peers: dict[str, AnyPeer] = {}
        self._served = Served(self)

    def stop(self) -> None:
        """Cancel what is served, give its workers a moment, and hear nothing any more."""
        self._served.leave(STOP_LIMIT)
        time.sleep(LAST_WORDS)
        super().stop()

    def close(self) -> None:
        """Stop, and leave the graph."""
        self.stop()
        self.leave()

    def peer(self, action_type: ActionType[G, R, F], name: str) -> Peer[G, R, F]:
        """The action server called `name`; one client is kept for all goals."""
        with self._making:
            if name not in self._peers:
                self._peers[name] = Peer(self, action_type, name)
            return self._peers[name]

    def serve(
        self,
        action_type: ActionType[G, R, F],
        name: str,
        run: Callable[[Goal[G, F]], Ended[R]],
        accept: Accept[G] | None = None,
    ) -> None:
        """Serve an action: `run` in a worker thread a goal, `accept` on the executor thread before.

        `run` must return soon after `goal.cancelled` is set. When it raises, the goal is aborted and the
        traceback logged.
        """
        self._served.serve(action_type, name, run, accept)
