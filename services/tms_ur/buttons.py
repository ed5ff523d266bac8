"""Starts of runs by nodes of the C++ system's version 6: its buttons, and interfaces that show them elsewhere.

Off unless `console: {buttons: [...]}` names tasks. Only stored tasks and trees that pass the check without a warning
are started; each start and refusal is audited with the nodes that publish the topic. Nothing here stops or re-arms:
`/emergency_signal` stops as ever, and a latched machine refuses the run.
"""

import json
import queue
from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING

import structlog
from diagnostic_msgs.msg import KeyValue
from std_msgs.msg import String

from tms_config.clock import monotonic
from tms_reason.errors import TmsError
from tms_reason.reason import Reason, Several
from tms_ros.node import Ros
from tms_runtime.graph import node_of
from tms_ur.reasons import NoTaskSequence

if TYPE_CHECKING:
    from tms_ur.audit import Audit
    from tms_ur.site_client import SiteClient

SEQUENCE, PERMISSION, REQUEST = "/task_sequence", "/urpermission", "/permissionrequest"
KEY, YES = "TASKGUI", "true"  # of its green button
PERIOD = 1.0  # s between requests, as there
MAX_WAITING = 10  # starts that wait for others; more are refused
KEPT_LIMIT = 1.0  # s that a start waits for its entry in the audit to be on the disk
AGAIN = 2.0  # s within which the same words are one press: its buttons may publish several times
log = structlog.stdlib.get_logger(__name__)


class Buttons:
    """Receives the topics on the executor thread, and starts runs in a thread of its own."""

    def __init__(self, ros: Ros, client: "SiteClient", audit: "Audit", tasks: Sequence[int]) -> None:
        self._ros, self._client, self._audit, self._tasks = ros, client, audit, tasks
        self._waiting: queue.Queue[tuple[str, str]] = queue.Queue(MAX_WAITING)  # topic, text
        self._last: dict[tuple[str, str], float] = {}  # when the same words came last, monotonic [s]
        request = KeyValue(key=KEY, value=",".join(map(str, tasks)))
        publisher = ros.publisher(KeyValue, REQUEST)
        ros.every(PERIOD, lambda: publisher.publish(request))
        ros.subscribe(String, SEQUENCE, lambda message: self.heard(SEQUENCE, message.data), depth=MAX_WAITING)
        ros.subscribe(KeyValue, PERMISSION, self._permitted, depth=MAX_WAITING)
        ros.begin(self._work, "buttons")

    def _permitted(self, message: KeyValue) -> None:
        if (message.key, message.value) == (KEY, YES):
            self.heard(PERMISSION, "")

    def heard(self, topic: str, text: str) -> None:
        """Have a press done, unless it repeats the last one or too many wait."""
        now = monotonic()
        self._last = {words: at for words, at in self._last.items() if now - at < AGAIN}
        repeated = (topic, text) in self._last
        self._last[topic, text] = now
        if repeated:
            return
        try:
            self._waiting.put_nowait((topic, text))
        except queue.Full:
            log.warning("press_left_out", topic=topic, waiting=MAX_WAITING)

    def _work(self) -> None:
        while True:
            self.do(*self._waiting.get())

    def do(self, topic: str, text: str) -> None:
        """Start what a press asks for; in a thread that may wait."""
        who = ", ".join(sorted({node_of(end) for end in self._ros.node.get_publishers_info_by_topic(topic)})) or "?"
        try:
            starts = [self._stored(number) for number in self._tasks] if topic == PERMISSION else self._trees(text)
        except TmsError as error:
            self._refused(who, topic, "task_sequence", error.reason)
            return
        for name, number in starts:
            try:
                self._start(who, topic, name, number())
            except TmsError as error:
                self._refused(who, topic, name, error.reason)

    def _stored(self, number: int) -> tuple[str, Callable[[], int]]:
        return f"task {number}", lambda: number

    def _trees(self, text: str) -> list[tuple[str, Callable[[], int]]]:
        return [(f"tree {place}", partial(self._checked, xml)) for place, xml in enumerate(trees(text), 1)]

    def _checked(self, xml: str) -> int:
        """The number under which a tree is stored, now or before.

        Raises:
            TmsError: what the check has found.
        """
        errors, warnings = self._client.check_task(xml)
        if found := tuple([*errors, *warnings]):
            raise TmsError(found[0] if len(found) == 1 else Several(found))
        return self._client.add_task(xml, f"from {SEQUENCE}")[0]

    def _start(self, who: str, topic: str, name: str, number: int) -> None:
        if not self._audit.put(who, topic, "start_run", f"task {number}").wait(KEPT_LIMIT):
            log.warning("audit_late", what="start_run", reason="the disk is slow; the command is in the log")
        run = self._client.start_run(number, ignore_warnings=False)
        log.info("started_by_button", run=run, task=number, asked=name, who=who)

    def _refused(self, who: str, topic: str, name: str, why: Reason) -> None:
        log.warning("start_refused", topic=topic, asked=name, who=who, reason=why)
        self._audit.refused(who, topic, "start_run", why.code)


def trees(text: str) -> list[str]:
    """The trees in a message of `/task_sequence`: a tree, or JSON `{"tasks": [{"task_id": 1, "task_sequence": XML}]}`.

    Raises:
        TmsError: it is JSON of another form.
    """
    if not text.lstrip().startswith("{"):
        return [text]
    try:
        found = [task["task_sequence"] for task in json.loads(text)["tasks"]]
    except (ValueError, TypeError, KeyError, RecursionError):
        raise TmsError(NoTaskSequence()) from None
    if not all(isinstance(one, str) for one in found):
        raise TmsError(NoTaskSequence())
    return found
