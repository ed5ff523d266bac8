"""Reports the nodes of a run: every change goes to the client, most changes go into the history."""

from collections.abc import Callable

from tms_msg_ts.action import ExecuteTask
from tms_msg_ts.msg import NodeStatus

from tms_config.clock import monotonic
from tms_reason.reason import Reason
from tms_reason.wire import to_line
from tms_ts.bt import IDLE, Node, Status, Tree
from tms_ts.budget import Budget
from tms_ts.facts import Facts
from tms_ts.reasons import LeftOut, NodeChanged, NodeChangedBecause, NodeFailed

FEEDBACK_PERIOD = 0.1  # s between messages to the client
LONGEST = 1.0  # s more between messages that tell the same: a client sees that the run goes on
CHANGES_A_TICK = 200  # node changes recorded of one tick; an endless loop makes thousands
FLOOD_REPORTED = 10.0  # s between events that count the changes left out
CHANGES_A_MESSAGE = 1000

LogNode = Callable[[str, Reason], None]  # path of the node, what


class NodeReport:
    """The report of one run; called by its thread."""

    def __init__(self, facts: Facts, log_node: LogNode, changed: Callable[[], None]) -> None:
        self._facts, self._log_node, self._changed = facts, log_node, changed
        self.failure: Reason | None = None  # of the last leaf that failed
        self.states = b""  # of every node, for the topic of active runs
        self.leaf = ""  # path of the first running leaf that has a reason
        self._changes: list[NodeStatus] = []  # for the client, in order
        self._all_reported = False  # whether the client knows the state of every node
        self._budget = Budget()
        self._changes_of_tick = self._left_out = 0
        self._flood_reported = -FLOOD_REPORTED
        self._told: tuple[str, list[tuple[Node, Reason | None]]] = "", []  # state and running leaves, last time
        self._next_feedback = 0.0

    def begin_tick(self) -> None:
        """Count the changes of a tick anew."""
        self._changes_of_tick = 0

    def changed(self, node: Node, old: Status, new: Status) -> None:
        """Take a change of a node; called by the tree."""
        if new is Status.FAILURE and node.reason and not node.children:
            self.failure = NodeFailed(node.name, node.reason, node.path)
        self._changes_of_tick += 1
        if self._changes_of_tick > CHANGES_A_TICK:
            self._left_out += 1
            self._all_reported = False  # the client gets the state of every node instead
            return
        self._changes.append(_message(node, new))
        if not self._budget.take(node.path):
            self._left_out += 1
            return
        self._log_node(node.path, _change(node, old, new))

    def report_flood(self, last: bool = False) -> None:
        """Record how many changes were left out: a loop that spins, or waits for hours, must not fill the history."""
        now = monotonic()
        if self._left_out and (last or now - self._flood_reported >= FLOOD_REPORTED):
            self._log_node("", LeftOut(self._left_out))
            self._left_out, self._flood_reported = 0, now

    def report(self, tree: Tree) -> None:
        """Keep the states of the nodes for the topic of active runs."""
        states = bytes(node.state for node in tree.nodes)
        running = next((node for node in tree.running() if node.reason), None)
        leaf, reason = (running.path, running.reason) if running is not None else ("", None)
        if self._facts.state != "running":
            reason = self._facts.reason
        if (states, leaf, reason) != (self.states, self.leaf, self._facts.reason):
            self.states, self.leaf, self._facts.reason = states, leaf, reason
            self._changed()

    def feedback(self, tree: Tree, last: bool = False) -> ExecuteTask.Feedback | None:
        """The next message to the client; None while it is too early or there is no change."""
        now, facts = monotonic(), self._facts
        if now < self._next_feedback and not last:
            return None
        running = [node for node in tree.running() if node.reason]
        told = facts.state, [(node, node.reason) for node in running]
        if self._all_reported and not self._changes and told == self._told and now < self._next_feedback + LONGEST:
            return None
        facts.reason = running[0].reason if running else facts.reason if facts.state == "stopping" else None
        message = ExecuteTask.Feedback(
            run_id=facts.run_id, state=facts.state, running_leaf=running[0].path if running else "",
            reason=to_line(facts.reason), nodes=self._nodes(tree, running),
        )  # fmt: skip
        self._all_reported, self._changes, self._told = True, [], told
        self._next_feedback = now + FEEDBACK_PERIOD
        return message

    def _nodes(self, tree: Tree, running: list[Node]) -> list[NodeStatus]:
        """Every node in the first message; later the changes in their order, and running leaves with a reason."""
        if not self._all_reported or len(self._changes) > CHANGES_A_MESSAGE:
            return [_message(node, node.state) for node in tree.nodes]
        return [*self._changes, *(_message(node, node.state) for node in running)]


def _change(node: Node, old: Status, new: Status) -> Reason:
    if new is IDLE or node.reason is None:
        return NodeChanged(node.name, old.name, new.name)
    return NodeChangedBecause(node.name, old.name, new.name, node.reason)


def _message(node: Node, status: Status) -> NodeStatus:
    return NodeStatus(
        uid=node.uid, parent=node.parent.uid if node.parent is not None else 0, name=node.name,
        type=node.registration_name, status=status,
        reason=to_line(node.reason) if status in (Status.RUNNING, Status.FAILURE) else "",
    )  # fmt: skip
