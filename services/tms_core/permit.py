"""The motion permit: processes stand behind goals by DDS liveliness, and others notice when one is lost.

Every process between scheduler and machine publishes on /<machine>/permit/<process> which goal it works for, and
asserts that topic as long as it does (MANUAL_BY_TOPIC, lease 500 ms). DDS tells the readers when the lease runs
out, whether the process was killed, frozen or cut off. A process that works for nothing asserts nothing.
"""

import secrets
import time
from collections.abc import Callable
from typing import Any

from tms_msg_rc.msg import Permit as Message

from tms_core.ros import Peer, Ros

LEASE = 0.5  # s without an assertion until a process counts as lost
GRACE = 0.1  # s more when the PC of the watcher itself did not run for a moment
NOBODY = bytes(16)
NO_INSTANCE = 0


def topic(machine: str, process: str) -> str:
    """Where a process of a machine tells what it works for; `ts` stands for the scheduler."""
    return f"/{machine}/permit/{process}"


class Permit:
    """The side of the process itself: `hold` while it works for a goal, `drop` afterwards."""

    def __init__(self, ros: Ros, machine: str, process: str, alive: Callable[[], bool] = lambda: True) -> None:
        """`alive` tells at every beat whether the process still does its work."""
        self._ros, self._process, self._alive = ros, process, alive
        self._instance = secrets.randbits(63) or 1
        self._publisher = ros.lease_publisher(Message, topic(machine, process), LEASE)

    def hold(self, goal: bytes, holder: str = "") -> None:
        """Stand behind a goal from now on."""
        self._publisher.publish(Message(process=self._process, goal=list(goal), holder=holder, instance=self._instance))
        self._ros.pulse.add(self._beat)

    def drop(self) -> None:
        """The goal is over; nothing is asserted any more."""
        self._ros.pulse.remove(self._beat)
        self._publisher.publish(Message(process=self._process, instance=self._instance))

    def _beat(self) -> None:
        if self._ros.pulse.works() and self._alive():
            self._publisher.assert_liveliness()


class Link:
    """What one process says that it works for, and whether it is still there. Readable from any thread."""

    def __init__(self, ros: Ros, machine: str, process: str, changed: Callable[["Link"], None]) -> None:
        self.process, self.goal, self.holder, self.instance = process, NOBODY, "", NO_INSTANCE
        self._ros, self._changed = ros, changed
        self.corpses = 0  # predecessors that discovery has not dropped yet, or the process itself while it is frozen
        self._heard, self._alive, self._asserted = 0.0, False, 0
        ros.lease_subscribe(Message, topic(machine, process), LEASE, self._on_message, self._on_liveliness)

    @property
    def alive(self) -> bool:
        """Whether the process works for `goal` now."""
        # A message may be handled before the news that its writer lives again.
        return self.goal != NOBODY and (self._alive or time.monotonic() - self._heard < LEASE)

    def _on_message(self, message: Any) -> None:
        self._heard = time.monotonic()
        self.goal, self.holder, self.instance = bytes(message.goal), message.holder, message.instance
        self._changed(self)

    def _on_liveliness(self, alive_count: int, not_alive_count: int) -> None:
        self._asserted, self.corpses = alive_count, not_alive_count
        if alive_count > 0:
            self._alive = True
        elif self._ros.pulse.late():  # its assertions may be there, but not handled yet
            self._ros.after(GRACE, self._judge)
            return
        else:
            self._alive, self._heard = False, 0.0
        self._changed(self)

    def _judge(self) -> None:
        if self._asserted == 0 and self._alive:
            self._alive, self._heard = False, 0.0
            self._changed(self)


def watch_server(ros: Ros, machine: str, process: str) -> Callable[[Peer], None]:
    """A function that makes open calls to a peer end as LOST when the process behind it is lost.

    Discovery does not tell: a restarted server has the same name, so the peer stays ready throughout.
    """
    watched = Watched()
    Link(ros, machine, process, watched.changed)
    return watched.add


class Watched:
    """Peers behind which one process stands. Pure logic, used on the executor thread."""

    def __init__(self) -> None:
        self._peers: list[Peer] = []
        self._holding = NO_INSTANCE  # the process that stood behind a goal at the last news
        self._missing = False

    def add(self, peer: Peer) -> None:
        """Tell this peer, too."""
        if peer not in self._peers:
            self._peers.append(peer)

    def changed(self, link: Link) -> None:
        """News of the process: it was lost, was only frozen, or another one has its name now."""
        before, self._holding = self._holding, NO_INSTANCE if link.goal == NOBODY else link.instance
        if before not in (NO_INSTANCE, link.instance):  # started anew, maybe within the lease of its predecessor
            lost, self._missing = not self._missing, False
        else:
            found = self._missing and link.alive and not link.corpses  # else it is the first sign of a successor
            lost = not link.alive and link.goal != NOBODY
            self._missing = lost or (self._missing and not found)
            for peer in self._peers if found else ():
                peer.found()
        for peer in self._peers if lost else ():
            peer.lost()
