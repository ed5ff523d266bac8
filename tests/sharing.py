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
LONGEST = (
    "test_v6_tasks", "test_every_subtask", "test_receipts", "test_official_tasks", "test_console", "test_areas",
    "test_several_losses", "test_earthwork", "test_power_cut", "test_shared_places", "test_rp_sim", "test_losses",
    "test_mc", "test_mesh", "test_sensing", "test_made_up", "test_mc_losses", "test_login", "test_ground",
    "test_leaf_forms", "test_board", "test_stand_in", "test_ur_crowd", "test_accessible", "test_stop",
    "test_views", "test_version6_planner", "test_faults", "test_intruders", "test_japanese", "test_readme",
    "test_sim_reports", "test_roles", "test_extending", "test_db", "test_start_refusals", "test_if",
    "test_upstream_peers", "test_first_trial", "test_gateway_stops", "test_newcomer", "test_ur", "test_people",
    "test_observability", "test_refusals", "test_backoff", "test_permission", "test_operasim", "test_tree",
    "test_paper", "test_phone",
)  # fmt: skip
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


def turn(item: pytest.Item) -> int:
    """When a test comes: what lasts longest first, tests of pure logic last."""
    if uses_mesh(item.path):
        return 0
    if item.path.stem in LONGEST:
        return 1 + LONGEST.index(item.path.stem)
    return 1 + len(LONGEST) + (not starts_processes(item.nodeid))
