"""The client of a run hears of every change soon, and now and then that nothing has changed."""

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest
from builtin_interfaces.msg import Time

from tms_reason.reason import Foreign
from tms_ts import node_report
from tms_ts.bt import Status
from tms_ts.facts import Facts
from tms_ts.node_report import FEEDBACK_PERIOD, LONGEST, NodeReport

DIGS = Foreign("digs: 10 %")


class Site:
    """A run with one leaf that runs, at a time that the test sets."""

    def __init__(self) -> None:
        self.now = 100.0
        self.leaf: Any = SimpleNamespace(
            name="dig", path="0.1", uid=2, parent=None, registration_name="Dig", reason=DIGS, state=Status.RUNNING
        )
        self.facts = Facts("run", 1, 1, "", ["zx200"], Time(), state="running")
        self.report = NodeReport(self.facts, lambda *_: None, lambda: None)
        self.tree: Any = SimpleNamespace(nodes=[self.leaf], running=lambda: [self.leaf])

    def told(self, later: float) -> list[str] | None:
        """The reasons of the next message, so much [s] later; None for no message."""
        self.now += later
        message = self.report.feedback(self.tree)
        return None if message is None else [node.reason for node in message.nodes]


@pytest.fixture
def site(monkeypatch: pytest.MonkeyPatch) -> Site:
    made = Site()
    monkeypatch.setattr(node_report, "monotonic", lambda: made.now)
    made.told(0.0)  # the first message has every node
    return made


def new_reason(site: Site) -> None:
    site.leaf.reason = Foreign("digs: 20 %")


def new_state(site: Site) -> None:
    site.facts.state = "stopping"


def change(site: Site) -> None:
    site.report.changed(site.leaf, Status.IDLE, Status.RUNNING)


@pytest.mark.parametrize("happens", [new_reason, new_state, change])
def test_what_has_changed_is_told_at_the_next_period(site: Site, happens: Callable[[Site], None]) -> None:
    assert site.told(2 * FEEDBACK_PERIOD) is None
    happens(site)
    assert site.told(FEEDBACK_PERIOD) is not None
    happens(site)
    assert site.told(FEEDBACK_PERIOD / 2) is None  # too early


def test_that_nothing_has_changed_is_told_now_and_then(site: Site) -> None:
    assert site.told(LONGEST) is None
    assert site.told(2 * FEEDBACK_PERIOD) == ['FOREIGN words="digs: 10 %"']
    assert site.told(LONGEST) is None
