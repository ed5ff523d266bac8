"""What unit tests share: nothing that one of them binds to its log lines reaches the next."""

from collections.abc import Iterator

import pytest
from structlog.contextvars import bound_contextvars, clear_contextvars


@pytest.fixture(autouse=True)
def own_log_fields() -> Iterator[None]:
    """Code that runs on a goal's own thread in the product runs on the one thread of all tests here."""
    with bound_contextvars():
        clear_contextvars()
        yield
