"""The journal of runs on its way through a real tms:db into a real store: large entries, and one that is refused."""

from collections.abc import Iterator
from pathlib import Path

import pytest
import structlog
from tms_msg_db.msg import Event
from tms_msg_db.srv import ListEvents

from few_processes import Mesh, bare
from tms_machine.values import to_parameters
from tms_ts.group_commit import GroupCommit
from tms_ts.journal import LOST, Journal

pytestmark = pytest.mark.ros
NAMES = ("paths", "names", "types", "kinds", "ports")  # what the scheduler tells of a tree


@pytest.fixture
def mesh(tmp_path: Path, own_domain: int) -> Iterator[Mesh]:
    for mesh in bare(tmp_path, own_domain, Mesh):
        mesh.start("tms:store")
        mesh.start("tms:db")
        mesh.wait_ready()
        yield mesh


def tree(number: int, nodes: int, length: int) -> Event:
    """As of a tree with so many nodes, each told in five texts of a length."""
    values = to_parameters({name: [f"{node:0{length}}" for node in range(nodes)] for name in NAMES})
    return Event(run_id="r", number=number, kind="tree", values=values)


def test_large_entries_arrive_and_one_that_no_store_takes_keeps_nobody_waiting(mesh: Mesh, tmp_path: Path) -> None:
    def stored() -> list[tuple[int, int]]:
        events = mesh.db(ListEvents, "list_events", run_id="r").events
        return [(event.number, len(event.values[0].value.string_array_value)) for event in events]

    before = LOST._value.get()
    disk = GroupCommit(structlog.stdlib.get_logger("disk"))
    journal = Journal(mesh.ros, structlog.stdlib.get_logger("journal"), disk, tmp_path / "state")
    journal.put(tree(1, 6000, 50))
    journal.put(tree(2, 20_000, 130))  # the most nodes that a tree may have
    journal.put(tree(3, 20_000, 158))  # small enough for ROS, larger than 16 MB as a document
    journal.put(tree(4, 10, 10))
    mesh.until(lambda: stored() == [(1, 6000), (2, 20_000), (4, 10)], "what can be stored")
    assert LOST._value.get() == before + 1
    disk.close(10)
    journal.close()
