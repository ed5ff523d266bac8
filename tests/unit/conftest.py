"""What unit tests share: nothing that one of them binds to its log lines reaches the next."""

from collections.abc import Iterator

import pytest

from tms_core import log


@pytest.fixture(autouse=True)
def own_log_fields() -> Iterator[None]:
    """Code that runs on a goal's own thread in the product runs on the one thread of all tests here."""
    token = log._bound.set({})
    yield
    log._bound.reset(token)
