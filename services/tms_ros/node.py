"""A node as this system uses it: calls are safe from any thread."""

import threading
from contextlib import AbstractContextManager

from tms_config.clock import sleep
from tms_interfaces.generated import ActionType, F, G, R
from tms_ros.client import AnyPeer, Peer
from tms_ros.loop import EventLoop
from tms_ros.server import ActionServers
from tms_ros.services import Services
from tms_ros.topics import Topics

WORKERS_LIMIT = 1.0  # s for the workers of served goals to stop their motions
LAST_WORDS = 0.1  # s for results and reasons to be sent before this process leaves


class Ros:
    """One node, with the methods of its thread and timers (loop.py), topics, services and actions."""

    def __init__(
        self, name: str, namespace: str = "/", process: str = "", creating: AbstractContextManager[None] | None = None
    ) -> None:
        """See `EventLoop`."""
        self.loop = loop = EventLoop(name, namespace, process, creating)
        self.topics = topics = Topics(loop)
        self.services = services = Services(loop)
        self._served = ActionServers(loop)
        self._peers: dict[str, AnyPeer] = {}
        self._making = threading.Lock()

        self.node, self.process, self.failed = loop.node, loop.process, loop.failed
        self.on_executor, self.start, self.create_future = loop.on_executor, loop.start, loop.create_future
        self.every, self.after, self.poll_in_thread, self.now = loop.every, loop.after, loop.poll_in_thread, loop.now
        self.begin, self.on_stop, self.leave = loop.begin, loop.on_stop, loop.leave
        self.busy_since, self.thread_number, self.wait_for = loop.busy_since, loop.thread_number, loop.wait_for
        self.publisher, self.subscribe, self.subscribe_raw = topics.publisher, topics.subscribe, topics.subscribe_raw
        self.delivered, self.sample, self.sample_arrivals = topics.delivered, topics.sample, topics.sample_arrivals
        self.lease_publisher, self.lease_subscribe = topics.lease_publisher, topics.lease_subscribe
        self.offer, self.offer_slow, self.prepare = services.offer, services.offer_slow, services.prepare
        self.call, self.call_async = services.call, services.call_async
        self.call_then, self.call_now = services.call_then, services.call_now
        self.call_unanswered, self.has_service = services.call_unanswered, services.has_service
        self.serve = self._served.serve

    @property
    def closing(self) -> bool:
        """Whether no message can be sent any more."""
        return self.loop.closing

    def stop(self) -> None:
        """Cancel the served goals, give their workers a moment, and end all reception."""
        self._served.leave(WORKERS_LIMIT)
        sleep(LAST_WORDS)
        self.loop.stop()

    def close(self) -> None:
        """Stop, and leave the graph."""
        self.stop()
        self.leave()

    def peer(self, action_type: ActionType[G, R, F], name: str) -> Peer[G, R, F]:
        """The action server `name`; all goals use one client."""
        with self._making:
            if name not in self._peers:
                self._peers[name] = Peer(self.loop, action_type, name)
            return self._peers[name]
