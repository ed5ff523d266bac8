"""What tests of the scheduler share."""

import logging
from collections.abc import Iterator

import pytest

from tms_core.group_commit import GroupCommit


@pytest.fixture
def disk() -> Iterator[GroupCommit]:
    made = GroupCommit(logging.getLogger("disk"))
    yield made
    made.close(10)
