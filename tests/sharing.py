"""Which tests of a run are done by the same worker of pytest-xdist, and in which order.

A mesh costs six seconds to start and a tenth of a processor while it waits: only one worker has that of the test run.
"""

import re
from functools import cache
from pathlib import Path

import pytest
from xdist.scheduler import LoadFileScheduling

TESTS = Path(__file__).resolve().parent
PROCESSES = ("browser", "docker", "ros", "system")  # folders of tests that start processes of the mesh
LONGEST = ("test_several_losses", "test_power_cut", "test_receipts", "test_official_tasks", "test_every_subtask",
           "test_sensing")  # fmt: skip
USES_MESH = re.compile(r"^def test_\w+\([^)]*\b(mesh|idle): Mesh", re.MULTILINE)
OWN_MESH = re.compile(r"^def mesh\(", re.MULTILINE)


class OneMesh(LoadFileScheduling):
    """Hands out file by file, but all files that use the mesh of the test run at once."""

    def _split_scope(self, nodeid: str) -> str:
        file: str = super()._split_scope(nodeid)
        return "mesh" if uses_mesh(TESTS.parent / file) else file


@cache
def uses_mesh(file: Path) -> bool:
    """Whether tests of a file use the mesh of the test run, and not one of their module."""
    text = file.read_text(encoding="utf-8")
    return USES_MESH.search(text) is not None and OWN_MESH.search(text) is None


def turn(item: pytest.Item) -> int:
    """When a test comes: what lasts longest first. Tests of pure logic fill the processors while others wait."""
    if uses_mesh(item.path):
        return 0
    if item.path.stem in LONGEST:
        return 1 + LONGEST.index(item.path.stem)
    return 10 if item.path.relative_to(TESTS).parts[0] in PROCESSES else 11
