"""The motion permit: processes stand behind goals by DDS liveliness, so that others detect the loss of one.

Every process between scheduler and machine publishes on /<machine>/permit/<process> which goal it works for, and
asserts that topic as long as it does (MANUAL_BY_TOPIC, lease 500 ms). When the lease runs out, DDS notifies the
readers, whether the process was killed, frozen or cut off. A process without a goal does not assert its topic.
"""

from collections.abc import Callable

from tms_msg_rc.msg import Permit as Message

from tms_config.clock import monotonic
from tms_decision.permit_link import GRACE, LEASE, NOBODY, PermitLink
from tms_ros.client import AnyPeer
from tms_ros.node import Ros
from tms_runtime import leases
from tms_runtime.pulse import Pulse

AGAIN = 0.09  # s to the next assertion: at every second beat, as each wakes all of a machine, and at each that is late


def topic(machine: str, process: str) -> str:
    """The topic of a process's permit; `ts` stands for the scheduler."""
    return f"/{machine}/permit/{process}"


class Permit:
    """The permit of this process: `hold` while it works for a goal, `drop` afterwards."""

    def __init__(
        self, ros: Ros, pulse: Pulse, machine: str, process: str, alive: Callable[[], bool] = lambda: True
    ) -> None:
        """`alive` is called at every beat: whether the process still does its work."""
        self._ros, self._pulse, self._process, self._alive, self._asserted = ros, pulse, process, alive, 0.0
        self._publisher = ros.lease_publisher(Message, topic(machine, process), LEASE)

    def hold(self, goal: bytes, holder: str = "") -> None:
        """Stand behind a goal from now on."""
        self._publisher.publish(Message(process=self._process, goal=list(goal), holder=holder))
        self._pulse.add(self._beat)

    def drop(self) -> None:
        """End the assertions, as the goal is over."""
        self._pulse.remove(self._beat)
        self._publisher.publish(Message(process=self._process))

    def end(self) -> None:
        """Leave the topic; on the executor thread."""
        self._ros.node.destroy_publisher(self._publisher)

    def _beat(self) -> None:
        now = monotonic()
        if now - self._asserted > AGAIN and self._pulse.works() and self._alive():
            self._asserted = now
            self._publisher.assert_liveliness()


class RemotePermit:
    """The permit of another process: its goal, and whether it is alive. Readable from any thread."""

    def __init__(
        self, ros: Ros, pulse: Pulse, machine: str, process: str, changed: Callable[["RemotePermit"], None]
    ) -> None:
        self._link = PermitLink(process)
        self._ros, self._pulse, self._changed = ros, pulse, changed
        leases.subscribe(ros, Message, topic(machine, process), LEASE, self._on_message, self._on_liveliness)

    @property
    def goal(self) -> bytes:
        return self._link.goal

    @property
    def holder(self) -> str:
        return self._link.holder

    @property
    def left(self) -> bool:
        """Whether the last one ended in order; a killed one leaves a stale writer."""
        return self._link.left

    @property
    def stale_writers(self) -> int:
        """Predecessors that discovery has not dropped yet, or the process itself while it is frozen."""
        return self._link.stale_writers

    @property
    def alive(self) -> bool:
        """Whether the process works for `goal` now."""
        return self._link.alive(monotonic())

    @property
    def alone(self) -> bool:
        """Whether it is alive and the only one: of two, nobody knows which has told what is heard."""
        return self.alive and self._link.asserted < 2

    def lost(self, goal: bytes) -> bool:
        """Whether the process was lost while it worked for `goal`: its successor may take the next one unheard."""
        return self.goal == goal and not self.alive

    def _on_message(self, message: Message) -> None:
        self._link.heard(bytes(message.goal), message.holder, monotonic())
        self._changed(self)

    def _on_liveliness(self, alive_count: int, not_alive_count: int) -> None:
        self._link.reported(alive_count, not_alive_count, self._pulse.late(), monotonic())
        if self._link.doubted is None:
            self._changed(self)
        else:
            self._ros.after(GRACE, self._judge)

    def _judge(self) -> None:
        if self._link.judge(float("inf")):  # its time is over
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
