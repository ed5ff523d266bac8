"""However a run ends, its machines are stopped."""

import logging
from types import SimpleNamespace
from typing import Any

import pytest
from builtin_interfaces.msg import Time

from tms_ts.run import Facts, Run


class Machines:
    """Those of the run; what was asked of them."""

    def __init__(self) -> None:
        self.stopped: list[str] = []

    def stop_all(self, machines: list[str], cause: str) -> list[Any]:
        self.stopped += machines
        return []


def broken() -> None:
    raise RuntimeError("a bug")


@pytest.mark.parametrize("outcome", ["success", "failure", "cancelled"])
def test_a_bug_while_the_tree_is_halted_does_not_keep_the_machines_from_being_stopped(outcome: str) -> None:
    machines, record = Machines(), SimpleNamespace(event=lambda _: None)
    run = Run(
        SimpleNamespace(now=Time),  # type: ignore[arg-type]
        SimpleNamespace(put=lambda _: None),  # type: ignore[arg-type]
        logging.getLogger("test"),
        SimpleNamespace(request=SimpleNamespace(resume="")),  # type: ignore[arg-type]
        Facts("run", 1, 1, "", ["zx200"], Time()),
        record,  # type: ignore[arg-type]
        lambda: None,
    )
    with pytest.raises(RuntimeError, match="a bug"):
        run._settle(SimpleNamespace(halt=broken), machines, outcome)  # type: ignore[arg-type]
    assert machines.stopped == ["zx200"]
