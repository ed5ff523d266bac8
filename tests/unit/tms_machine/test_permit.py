"""What a watcher makes of the news of a lease; DDS itself is replaced."""

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest
from tms_msg_rc.msg import Permit as Message

from tms_decision.permit_link import GRACE
from tms_machine.permit import Permit, RemotePermit, watch_server
from tms_runtime import leases

GOAL = [7] * 16


class Dds:
    """What a RemotePermit needs of Ros: keeps the callbacks, and decides whether this process was late."""

    def __init__(self) -> None:
        self.pulse = self
        self.was_late = False
        self.later: list[tuple[float, Callable[[], None]]] = []

    def late(self) -> bool:
        return self.was_late

    def after(self, seconds: float, step: Callable[[], None]) -> None:
        self.later.append((seconds, step))

    def subscribe(self, _ros: Any, _type: Any, _topic: str, _lease: float, received: Any, alive: Any) -> None:
        self.received, self.alive = received, alive


@pytest.fixture
def dds(monkeypatch: pytest.MonkeyPatch) -> Dds:
    made = Dds()
    monkeypatch.setattr(leases, "subscribe", made.subscribe)
    return made


@pytest.fixture
def permit(dds: Dds) -> tuple[RemotePermit, list[bool]]:
    seen: list[bool] = []
    made = RemotePermit(dds, dds, "zx200", "rc", lambda permit: seen.append(permit.alive))  # type: ignore[arg-type]
    dds.received(Message(process="rc", goal=GOAL))
    dds.alive(1, 0)
    return made, seen


def test_a_lapsed_lease_is_a_loss_at_once(dds: Dds, permit: tuple[RemotePermit, list[bool]]) -> None:
    dds.alive(0, 1)
    assert permit[1][-1] is False and not permit[0].alive and not dds.later


def test_a_watcher_that_was_late_itself_waits_for_a_sign_of_life(
    dds: Dds, permit: tuple[RemotePermit, list[bool]]
) -> None:
    dds.was_late = True
    dds.alive(0, 1)
    assert permit[0].alive and dds.later[0][0] == GRACE
    dds.alive(1, 0)
    dds.later[0][1]()
    assert permit[0].alive and all(permit[1])


def test_it_does_not_wait_for_ever(dds: Dds, permit: tuple[RemotePermit, list[bool]]) -> None:
    dds.was_late = True
    dds.alive(0, 1)
    dds.later[0][1]()
    assert not permit[0].alive and permit[1][-1] is False


def test_a_process_is_lost_for_the_goal_that_it_worked_for_alone(
    dds: Dds, permit: tuple[RemotePermit, list[bool]]
) -> None:
    assert not permit[0].lost(bytes(GOAL))
    dds.alive(0, 1)
    assert permit[0].lost(bytes(GOAL))
    assert not permit[0].lost(bytes([8] * 16)), "its successor has taken this one, and its permit is still on its way"


@pytest.mark.parametrize("stale_writers", [0, 1])  # of predecessors
def test_who_takes_leave_leaves_no_stale_writer(
    dds: Dds, permit: tuple[RemotePermit, list[bool]], stale_writers: int
) -> None:
    dds.alive(1, stale_writers)
    dds.alive(0, stale_writers)
    assert not permit[0].alive
    assert permit[0].left is (stale_writers == 0), "with a stale one: killed, while discovery dropped its predecessor"
    dds.alive(1, stale_writers)
    assert not permit[0].left
    dds.alive(0, stale_writers + 1)
    assert not permit[0].alive and not permit[0].left
    dds.alive(0, 0)  # discovery drops the stale writer
    assert not permit[0].left


class Server:
    """What a watcher needs of a Peer: keeps what it was told."""

    def __init__(self) -> None:
        self.reported: list[str] = []

    def mark_lost(self) -> None:
        self.reported.append("lost")

    def mark_alive(self) -> None:
        self.reported.append("found")


@pytest.fixture
def server(dds: Dds) -> Server:
    made = Server()
    watch_server(dds, dds, "zx200", "rc")(made)  # type: ignore[arg-type]
    dds.received(Message(process="rc", goal=GOAL))
    dds.alive(1, 0)
    made.reported.clear()
    return made


def test_a_frozen_process_that_runs_again_is_found(dds: Dds, server: Server) -> None:
    dds.alive(0, 1)
    dds.alive(1, 0)
    assert server.reported == ["lost", "found"]


def test_a_successor_is_not_taken_for_the_process_that_was_lost(dds: Dds, server: Server) -> None:
    dds.alive(0, 1)
    dds.alive(1, 1)
    dds.received(Message(process="rc", goal=GOAL))
    assert server.reported == ["lost"]


def test_a_process_that_ends_between_two_goals_loses_none(dds: Dds, server: Server) -> None:
    dds.received(Message(process="rc"))
    server.reported.clear()
    dds.alive(0, 1)
    assert not server.reported


class Lease:
    """A process with a permit, and when it asserted that [s]; the beats come when they are told to."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.now, self.asserted, self.working = 100.0, list[float](), True
        monkeypatch.setattr("tms_machine.permit.monotonic", lambda: self.now)
        publisher = SimpleNamespace(
            publish=lambda _: None, assert_liveliness=lambda: self.asserted.append(round(self.now - 100.0, 3))
        )
        ros: Any = SimpleNamespace(lease_publisher=lambda *_: publisher)
        pulse: Any = SimpleNamespace(add=self._add, works=lambda: self.working)
        Permit(ros, pulse, "zx200", "ts").hold(bytes(16))

    def _add(self, beat: Callable[[], None]) -> None:
        self._beat = beat

    def beats(self, *after: float) -> list[float]:
        """Beat so many seconds after the last beat, each time; when it asserted."""
        for seconds in after:
            self.now += seconds
            self._beat()
        return self.asserted


def test_a_permit_is_asserted_at_every_second_beat(monkeypatch: pytest.MonkeyPatch) -> None:
    assert Lease(monkeypatch).beats(*6 * [0.0502]) == [0.05, 0.151, 0.251]


def test_a_permit_is_asserted_at_each_beat_that_is_late(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two beats in a row that a busy PC has run 0.25 s late would else be the end of its lease of 0.5 s."""
    assert Lease(monkeypatch).beats(0.05, 0.3, 0.3, 0.05, 0.05) == [0.05, 0.35, 0.65, 0.75]


def test_a_permit_is_not_asserted_while_the_process_does_not_work(monkeypatch: pytest.MonkeyPatch) -> None:
    lease = Lease(monkeypatch)
    lease.working = False
    assert lease.beats(0.05, 0.3) == []
    lease.working = True
    assert lease.beats(0.05) == [0.4]
