"""The motion permit: processes stand behind goals by DDS liveliness, so that others detect the loss of one.

Every process between scheduler and machine publishes on /<machine>/permit/<process> which goal it works for, and
asserts that topic as long as it does (MANUAL_BY_TOPIC, lease 500 ms). When the lease runs out, DDS notifies the
readers, whether the process was killed, frozen or cut off. A process without a goal does not assert its topic.
"""

from collections.abc import Callable

from tms_msg_rc.msg import Permit as Message

from tms_config.clock import monotonic
from tms_ros.client import AnyPeer
from tms_ros.node import Ros
from tms_runtime import leases
from tms_runtime.pulse import Pulse

BEATS = 2  # beats of the pulse from one assertion to the next: each assertion wakes every process of the machine
LEASE = 0.5  # s without an assertion until a process counts as lost
GRACE = 0.1  # s more when the reader's own PC did not run for a moment
NOBODY = bytes(16)


def topic(machine: str, process: str) -> str:
    """The topic of a process's permit; `ts` stands for the scheduler."""
    return f"/{machine}/permit/{process}"


class Permit:
    """The permit of this process: `hold` while it works for a goal, `drop` afterwards."""

    def __init__(
        self, ros: Ros, pulse: Pulse, machine: str, process: str, alive: Callable[[], bool] = lambda: True
    ) -> None:
        """`alive` is called at every beat: whether the process still does its work."""
        self._pulse, self._process, self._alive = pulse, process, alive
        self._beats = 0
        self._publisher = ros.lease_publisher(Message, topic(machine, process), LEASE)

    def hold(self, goal: bytes, holder: str = "") -> None:
        """Stand behind a goal from now on."""
        self._publisher.publish(Message(process=self._process, goal=list(goal), holder=holder))
        self._pulse.add(self._beat)

    def drop(self) -> None:
        """End the assertions, as the goal is over."""
        self._pulse.remove(self._beat)
        self._publisher.publish(Message(process=self._process))

    def _beat(self) -> None:
        self._beats += 1
        if self._beats % BEATS == 0 and self._pulse.works() and self._alive():
            self._publisher.assert_liveliness()


class RemotePermit:
    """The permit of another process: its goal, and whether it is alive. Readable from any thread."""

    def __init__(
        self, ros: Ros, pulse: Pulse, machine: str, process: str, changed: Callable[["RemotePermit"], None]
    ) -> None:
        self.process, self.goal, self.holder = process, NOBODY, ""
        self._ros, self._pulse, self._changed = ros, pulse, changed
        self.stale_writers = (
            0  # predecessors that discovery has not dropped yet, or the process itself while it is frozen
        )
        self.left = False  # the last one ended in order; a killed one leaves a stale writer
        self._received, self._alive, self._asserted = 0.0, False, 0
        leases.subscribe(ros, Message, topic(machine, process), LEASE, self._on_message, self._on_liveliness)

    @property
    def alive(self) -> bool:
        """Whether the process works for `goal` now."""
        # A message may be handled before the report that its writer is asserted again.
        return self.goal != NOBODY and (self._alive or monotonic() - self._received < LEASE)

    def _on_message(self, message: Message) -> None:
        self._received = monotonic()
        self.goal, self.holder = bytes(message.goal), message.holder
        self._changed(self)

    def _on_liveliness(self, alive_count: int, not_alive_count: int) -> None:
        if alive_count > 0 or self._asserted > 0:
            self.left = alive_count == 0 and not_alive_count <= self.stale_writers
        self._asserted, self.stale_writers = alive_count, not_alive_count
        if alive_count > 0:
            self._alive = True
        elif self._pulse.late():  # its assertions may have come, but not been handled yet
            self._ros.after(GRACE, self._judge)
            return
        else:
            self._alive, self._received = False, 0.0
        self._changed(self)

    def _judge(self) -> None:
        if self._asserted == 0 and self._alive:
            self._alive, self._received = False, 0.0
            self._changed(self)


def watch_server(ros: Ros, pulse: Pulse, machine: str, process: str) -> Callable[[AnyPeer], None]:
    """A function that adds a peer, whose open calls end as LOST when the process behind it is lost.

    Discovery does not show this loss: a restarted server has the same name, so the peer stays ready throughout.
    """
    peers: list[AnyPeer] = []

    def changed(permit: RemotePermit) -> None:
        for peer in peers:
            if permit.alive and not permit.stale_writers:  # with a stale writer, this is the first sign of a successor
                peer.mark_alive()
            elif not permit.alive and permit.goal != NOBODY:
                peer.mark_lost()

    def add(peer: AnyPeer) -> None:
        if peer not in peers:
            peers.append(peer)

    RemotePermit(ros, pulse, machine, process, changed)
    return add
