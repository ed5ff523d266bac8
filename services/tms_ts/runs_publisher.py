"""Publishes the active runs: the latched topic and the metrics."""

import threading
from collections import Counter

from prometheus_client import Gauge
from tms_msg_ts.msg import RunStates

from tms_ros.node import Ros
from tms_ts.active_runs import ActiveRuns
from tms_ts.bt import Status
from tms_ts.questions import Questions

STATES = ("preparing", "running", "stopping")
ACTIVE = Gauge("tms_ts_active_runs", "Active runs by state", ["state"])
NODES = Gauge("tms_ts_tree_nodes", "Nodes of the active runs' trees by status", ["status"])
LONGEST_PERIOD = 1.0  # s between messages on the topic of active runs without changes ...
SHORTEST_PERIOD = 0.05  # s ... and with changes all the time


class RunsPublisher:
    """Publishes changes at once, but not more often than a person can see."""

    def __init__(self, ros: Ros, runs: ActiveRuns, topic: str) -> None:
        self._runs = runs
        self._changed, self._closing = threading.Event(), threading.Event()
        self.questions = Questions(ros, self._changed.set)
        self._publisher = ros.publisher(RunStates, topic, depth=1, latched=True)
        threading.Thread(target=self._publish, name="runs", daemon=True).start()

    def changed(self) -> None:
        """Have a change published; returns at once."""
        self._changed.set()

    def close(self) -> None:
        """End publishing."""
        self._closing.set()

    def _publish(self) -> None:
        while not self._closing.wait(SHORTEST_PERIOD):
            self._changed.wait(LONGEST_PERIOD - SHORTEST_PERIOD)
            self._changed.clear()
            if not self._closing.is_set():
                states = [run.state() for run in self._runs]
                self._publisher.publish(RunStates(runs=states, questions=self.questions.messages()))

    def measure(self) -> None:
        """Update the metrics."""
        runs = list(self._runs)
        for state in STATES:
            ACTIVE.labels(state).set(sum(run.facts.state == state for run in runs))
        counted = Counter(state for run in runs for state in run.nodes.states)
        for status in Status:
            NODES.labels(status.name.lower()).set(counted[status])
