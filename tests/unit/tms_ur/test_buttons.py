"""Starts by nodes of the C++ system's version 6: what is started, what is refused, and what the audit has of it."""

import json
import threading
from types import SimpleNamespace
from typing import Any

import pytest

from tms_machine.reasons import NoReason
from tms_reason.errors import TmsError
from tms_reason.reason import Reason
from tms_ur import buttons
from tms_ur.buttons import PERMISSION, SEQUENCE, Buttons, trees
from tms_ur.reasons import NoTaskSequence, Starting

GOOD, DOUBTFUL = "<root>good</root>", "<root>doubtful</root>"


class Site:
    """ROS, scheduler, database and audit, as far as buttons need them; a test does the steps of the thread."""

    def __init__(self) -> None:
        self.published: list[Any] = []
        self.heard: dict[str, Any] = {}
        self.started: list[tuple[int, bool]] = []
        self.audited: list[tuple[str, ...]] = []
        self.refuses: Reason | None = None
        self.node = SimpleNamespace(get_publishers_info_by_topic=lambda _: [
            SimpleNamespace(node_namespace="/", node_name=name) for name in ("ur_button", "ur_button")
        ])  # fmt: skip

    def publisher(self, *_: Any) -> Any:
        return SimpleNamespace(publish=self.published.append)

    def every(self, _: float, step: Any) -> None:
        step()

    def subscribe(self, _: Any, topic: str, received: Any, depth: int) -> None:
        self.heard[topic] = received

    def begin(self, *_: Any) -> None:
        """The thread is the test's own."""

    def check_task(self, xml: str) -> tuple[list[Reason], list[Reason]]:
        return [], [NoReason()] if xml == DOUBTFUL else []

    def add_task(self, xml: str, description: str) -> tuple[int, bool]:
        assert description == "from /task_sequence"
        return 40 + len(xml), True

    def start_run(self, number: int, ignore_warnings: bool) -> str:
        if self.refuses is not None:
            raise TmsError(self.refuses)
        self.started.append((number, ignore_warnings))
        return "r1"

    def put(self, *note: str) -> threading.Event:
        self.audited.append(note)
        kept = threading.Event()
        kept.set()
        return kept

    def refused(self, *note: str) -> None:
        self.audited.append(note)


@pytest.fixture
def site() -> Site:
    return Site()


@pytest.fixture
def pressed(site: Site) -> Buttons:
    parts: Any = site
    return Buttons(parts, parts, parts, (1, 4))


def test_the_tasks_that_may_be_started_are_published(site: Site, pressed: Buttons) -> None:
    assert [(one.key, one.value) for one in site.published] == [("TASKGUI", "1,4")]


def test_a_permission_starts_the_tasks_of_the_site_file(site: Site, pressed: Buttons) -> None:
    pressed.do(PERMISSION, "")
    assert site.started == [(1, False), (4, False)]  # a warning refuses: nobody there has read it
    assert site.audited == [("/ur_button", PERMISSION, "start_run", f"task {number}") for number in (1, 4)]


@pytest.mark.parametrize(
    ("key", "value", "starts"), [("TASKGUI", "true", 1), ("TASKGUI", "emergency", 0), ("8f3a", "true", 0)]
)
def test_only_its_green_button_is_a_permission(site: Site, pressed: Buttons, key: str, value: str, starts: int) -> None:
    site.heard[PERMISSION](SimpleNamespace(key=key, value=value))
    assert pressed._waiting.qsize() == starts


def test_a_tree_is_checked_stored_and_started(site: Site, pressed: Buttons) -> None:
    pressed.do(SEQUENCE, json.dumps({"tasks": [{"task_id": 9, "task_sequence": one} for one in (DOUBTFUL, GOOD)]}))
    assert site.started == [(40 + len(GOOD), False)]
    assert [note[3] for note in site.audited] == ["NO_REASON", f"task {40 + len(GOOD)}"]


def test_a_refused_start_is_audited(site: Site, pressed: Buttons) -> None:
    site.refuses = Starting(1)
    pressed.do(SEQUENCE, GOOD)
    assert site.audited[-1] == ("/ur_button", SEQUENCE, "start_run", "STARTING")


@pytest.mark.parametrize("text", ["{", "{}", '{"tasks": 1}', '{"tasks": [{"task_sequence": 1}]}', '{"tasks": ["x"]}'])
def test_a_message_without_trees_starts_nothing(site: Site, pressed: Buttons, text: str) -> None:
    pressed.do(SEQUENCE, text)
    assert site.started == [] and site.audited[-1][3] == NoTaskSequence.code


def test_one_tree_alone_is_no_json() -> None:
    assert trees(GOOD) == [GOOD]


def test_the_same_press_said_twice_is_one_press(site: Site, pressed: Buttons, monkeypatch: pytest.MonkeyPatch) -> None:
    now = 0.0
    monkeypatch.setattr(buttons, "monotonic", lambda: now)
    for now in (0.0, 1.0, 2.5, 5.0):  # noqa: B007  # the clock
        site.heard[SEQUENCE](SimpleNamespace(data=GOOD))
    assert pressed._waiting.qsize() == 2


def test_presses_that_find_no_room_are_left_out(site: Site, pressed: Buttons) -> None:
    for number in range(buttons.MAX_WAITING + 3):
        site.heard[SEQUENCE](SimpleNamespace(data=str(number)))
    assert pressed._waiting.qsize() == buttons.MAX_WAITING
