"""What tests of the scheduler share."""

from collections.abc import Iterator

import pytest
import structlog

from tms_ts.group_commit import GroupCommit


@pytest.fixture
def disk() -> Iterator[GroupCommit]:
    made = GroupCommit(structlog.stdlib.get_logger("disk"))
    yield made
    made.close(10)
