"""Which tests of a run are done by the same worker of pytest-xdist, and in which order.

A mesh costs six seconds to start and a tenth of a processor while it waits: only two workers have that of the test
run, one for the tests of the console in a browser and one for all others.
"""

import re
from functools import cache
from pathlib import Path

import pytest
from xdist.scheduler import LoadFileScheduling
from xdist.workermanage import WorkerController

TESTS = Path(__file__).resolve().parent
MESH, BROWSER_MESH = "the mesh of the test run", "the mesh of the test run, with a browser"
PROCESSES = ("tests/browser/", "tests/docker/", "tests/replay/test_replay", "tests/ros/", "tests/system/")
COSTS = {  # s of a processor, where a file takes many
    "test_v6_tasks": 229, "test_official_tasks": 183, "test_console": 159, "test_earthwork": 149,
    "test_every_subtask": 145, "test_made_up": 86, "test_several_losses": 78, "test_shared_places": 77,
    "test_power_cut": 71, "test_losses": 67, "test_sensing": 56, "test_receipts": 51, "test_leaf_forms": 51,
    "test_mesh": 50, "test_board": 40, "test_rp_sim": 40, "test_areas": 35, "test_login": 34, "test_two_schedulers": 35,
    "test_version6_planner": 33, "test_mc": 31, "test_views": 27, "test_stop": 27, "test_readme": 26,
    "test_extending": 25, "test_mc_losses": 25, "test_roles": 25, "test_accessible": 22, "test_ground": 19,
    "test_first_trial": 17, "test_stand_in": 16, "test_ur_crowd": 15, "test_refusals": 14, "test_paper": 13,
    "test_intruders": 13, "test_newcomer": 12, "test_permission": 12, "test_japanese": 12, "test_tree": 11,
    "test_phone": 11, "test_people": 11, "test_observability": 11, "test_start_refusals": 10,
    "test_shared_values": 10, "test_upstream_peers": 9, "test_record_lock": 8, "test_panel": 8, "test_faults": 8,
    "test_ur": 7, "test_gateway_stops": 7, "test_db": 7,
}  # fmt: skip
USES_MESH = re.compile(r"^def test_\w+\([^)]*\b(mesh|idle): Mesh", re.MULTILINE)
OWN_MESH = re.compile(r"^def mesh\(", re.MULTILINE)


class OneMesh(LoadFileScheduling):
    """Hands out file by file, but files that use the mesh of the test run all at once.

    The last worker begins with tests of pure logic: they use the processors while the others wait for their processes.
    """

    def _split_scope(self, nodeid: str) -> str:
        file: str = super()._split_scope(nodeid)
        if not uses_mesh(TESTS.parent / file):
            return file
        return BROWSER_MESH if file.startswith("tests/browser/") else MESH

    def _assign_work_unit(self, node: WorkerController) -> None:
        pure = node is self.nodes[-1] and len(self.nodes) > 1
        fitting = (unit for unit in self.workqueue if starts_processes(unit) != pure)
        if (unit := next(fitting, None)) is not None:
            self.workqueue.move_to_end(unit, last=False)
        super()._assign_work_unit(node)


def starts_processes(unit: str) -> bool:
    """Whether tests of a file, named from the project's folder, start processes of a mesh."""
    return unit in (MESH, BROWSER_MESH) or unit.startswith(PROCESSES)


@cache
def uses_mesh(file: Path) -> bool:
    """Whether tests of a file use the mesh of the test run, and not one of their module."""
    text = file.read_text(encoding="utf-8")
    return USES_MESH.search(text) is not None and OWN_MESH.search(text) is None


def rank(item: pytest.Item) -> int:
    """When a test comes: what lasts longest first, tests of pure logic last."""
    if uses_mesh(item.path):
        return -max(COSTS.values())
    return -cost(item.path) if cost(item.path) else 1 + (not starts_processes(item.nodeid))


def cost(file: Path) -> int:
    """Seconds of a processor that the tests of a file take; 0 where they are few."""
    return COSTS.get(file.stem, 0)
