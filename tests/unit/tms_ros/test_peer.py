"""Whether the server of a goal is there, and still the one that took the goal."""

from types import SimpleNamespace
from typing import Any

import pytest

from tms_ros import client
from tms_ros.client import STAYS, Peer

OLD, NEW = b"old", b"new"


class Site:
    """A graph with servers of one action, and what a process asks it; times are monotonic [s]."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.servers, self.connected, self.now, self.looks = {OLD}, True, 100.0, 0
        monkeypatch.setattr(client, "SureActionClient", lambda *_, **__: SimpleNamespace(server_is_ready=self._ready))
        monkeypatch.setattr(client, "monotonic", lambda: self.now)
        node = SimpleNamespace(get_publishers_info_by_topic=self._found)
        loop: Any = SimpleNamespace(node=node, group=None, on_executor=lambda step: step())
        self.peer: Any = Peer(loop, object, "/zx200/turn")

    def _ready(self) -> bool:
        self.looks += 1
        return self.connected

    def _found(self, _topic: str) -> list[Any]:
        self.looks += 1
        return [SimpleNamespace(endpoint_gid=one) for one in self.servers]

    def send(self) -> None:
        """A goal that all servers take that are there now."""
        self.peer._taken_by = frozenset(self.servers)


@pytest.fixture
def site(monkeypatch: pytest.MonkeyPatch) -> Site:
    return Site(monkeypatch)


@pytest.mark.parametrize(
    ("connected", "taken_by", "there", "left"),
    [
        (True, {OLD}, {OLD}, False),
        (True, {OLD}, {OLD, NEW}, False),
        (True, {OLD}, {NEW}, True),  # its successor has the same name, and knows nothing of the goal
        (True, set(), {NEW}, False),  # nobody knows who took it
        (False, {OLD}, {OLD}, True),
    ],
)
def test_a_server_has_left_when_none_that_took_the_goal_is_there(
    site: Site, connected: bool, taken_by: set[bytes], there: set[bytes], left: bool
) -> None:
    site.servers = taken_by
    site.send()
    site.servers, site.connected = there, connected
    assert site.peer.left() is left


def test_a_server_that_was_seen_is_not_looked_for_at_each_beat(site: Site) -> None:
    site.send()
    assert site.peer.ready() and not site.peer.left()
    site.looks = 0
    site.now += STAYS
    assert site.peer.ready() and not site.peer.left()
    assert site.looks == 0


def test_a_server_that_leaves_is_missed_soon(site: Site) -> None:
    site.send()
    assert site.peer.ready() and not site.peer.left()
    site.servers = set()
    site.now += 1.01 * STAYS
    assert not site.peer.ready() and site.peer.left()


def test_a_look_for_the_same_server_asks_for_no_more_than_its_name(site: Site) -> None:
    assert site.peer.ready()
    site.looks, site.connected = 0, False  # not asked
    site.now += 1.01 * STAYS
    assert site.peer.ready() and site.looks == 1


@pytest.mark.parametrize("back", [OLD, NEW])  # frozen until discovery dropped it, or started again
def test_a_server_that_is_back_has_to_be_connected_again(site: Site, back: bytes) -> None:
    assert site.peer.ready()
    site.servers = set()
    site.now += 1.01 * STAYS
    assert not site.peer.ready()
    site.servers, site.connected = {back}, False
    assert not site.peer.ready()
    site.connected = True
    assert site.peer.ready()


def test_another_server_of_the_name_has_to_be_connected(site: Site) -> None:
    assert site.peer.ready()
    site.servers, site.connected = {NEW}, False
    site.now += 1.01 * STAYS
    assert not site.peer.ready()


def test_a_server_that_comes_is_there_at_once(site: Site) -> None:
    site.connected = False
    assert not site.peer.ready()
    site.connected = True
    assert site.peer.ready()


def test_a_server_that_is_known_to_be_dead_has_left_at_once(site: Site) -> None:
    site.send()
    assert site.peer.ready() and not site.peer.left()
    site.peer.mark_lost()
    assert not site.peer.ready() and site.peer.left()
    site.servers = {OLD, NEW}
    assert site.peer.ready()  # its successor


def test_the_goal_of_a_dead_server_stays_lost_once_its_successor_is_there(site: Site) -> None:
    site.send()
    assert not site.peer.left()
    site.peer.mark_lost()
    site.servers = {NEW}
    assert site.peer.ready() and site.peer.left()


def test_the_goal_of_a_server_that_came_since_the_last_look_is_not_lost(site: Site) -> None:
    assert site.peer.ready()
    site.servers = {NEW}
    site.send()
    assert not site.peer.left()
