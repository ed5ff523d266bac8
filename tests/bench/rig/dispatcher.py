"""Gives the machines of a crowd (crowd.py) runs that go on for ever, and presses the stop button.

python dispatcher.py RUNS CROWDS

Prints `going` when every run goes. It presses the button when its input ends, and then prints as JSON when it did [ns
since 1970], and how many runs had not ended a while later. Nothing of the tests is imported: it runs in containers too.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable

from std_msgs.msg import Bool
from tms_msg_db.srv import AddTask, SetParameter
from tms_msg_ts.action import ExecuteTask

from tms_config.config import Site, load_site
from tms_machine.values import to_parameters
from tms_ros.client import Call
from tms_ros.node import Ros
from tms_runtime import environment
from tms_runtime.priority import URGENT, undisturbed
from tms_schedulers.names import Scheduler, schedulers

RECORDS = {  # deg of each joint; machines go from one to the other
    "BENCH": {"boom": -46.0, "swing": 0.0, "arm": 114.0, "bucket": 46.0},
    "BACK": {"boom": -20.0, "swing": 90.0, "arm": 80.0, "bucket": 0.0},
}
SUBTASKS = [f"st_zx200_sample_{joint}" for joint in RECORDS["BENCH"]]
LIMIT, END_LIMIT = 180.0, 20.0  # s; the first only bounds a hang, the second is for the runs to end after a stop
LEAF = '<Action ID="LeafNodeZx200" model_name="{}" record_name="{}" subtask_name="{}"/>'


def until(holds: Callable[[], bool], what: str) -> None:
    """Wait for something for at most LIMIT."""
    deadline = time.monotonic() + LIMIT
    while not holds():
        if time.monotonic() > deadline:
            raise TimeoutError(f"not within {LIMIT:.0f} s: {what}")
        time.sleep(0.05)


def store_records(ros: Ros, names: list[str]) -> None:
    """The records of each machine."""

    def stored(name: str, record: str) -> bool:
        values = to_parameters({f"zx200_{joint}_goal_pos": angle for joint, angle in RECORDS[record].items()})
        request = SetParameter.Request(
            model_name=name, record_name=record, type="static", source="bench", create=True, values=values
        )
        return not ros.call(SetParameter, "/tms/db/set_parameter", request, LIMIT).error_code

    until(lambda: stored(names[0], "BENCH"), "the database")
    assert all(stored(name, record) for name in names for record in RECORDS)


def start(ros: Ros, scheduler: Scheduler, runs: int, at_once: int = 100) -> list[Call]:
    """The machines of a scheduler dealt out to runs of it; so many begin at once, the next when these go."""
    names = sorted(scheduler.machines)
    hands = [names[number::runs] for number in range(min(runs, len(names)))]
    peer = ros.peer(ExecuteTask, scheduler.named("execute_task"))
    peer.wait_ready(LIMIT)
    calls = []
    for hand in hands:
        added = ros.call(AddTask, "/tms/db/add_task", AddTask.Request(task_sequence=_tree(hand)), LIMIT)
        assert not added.error_code, added.error_msg
        call = peer.send(ExecuteTask.Goal(task_id=added.task_id, ignore_warnings=True))
        calls.append(call)
        if len(calls) % at_once == 0:
            until(lambda: all(_goes(call) for call in calls[-at_once:]), "the runs go")
    return calls


def start_all(ros: Ros, site: Site, runs: int, at_once: int = 100) -> list[Call]:
    """`runs` at all schedulers together."""
    every = schedulers(site)
    calls = [call for scheduler in every for call in start(ros, scheduler, runs // len(every), at_once)]
    until(lambda: all(_goes(call) for call in calls), "every run goes")
    return calls


def press(ros: Ros, crowds: int) -> int:
    """Press the stop button, which more than all crowds hear; when that was [ns since 1970]."""
    button = ros.publisher(Bool, "/emergency_signal")
    until(lambda: button.get_subscription_count() > crowds, "every machine is known to the button")
    button.publish(Bool())
    assert ros.delivered(button, LIMIT), "not every machine knows the button"
    with undisturbed(URGENT):  # as the console and `tms stop` send it
        begun = time.time_ns()
        button.publish(Bool(data=True))
    return begun


def left(calls: list[Call]) -> int:
    """How many runs have not ended END_LIMIT after the stop."""
    deadline = time.monotonic() + END_LIMIT
    for call in calls:
        call.wait_for(lambda call=call: call.outcome is not None, deadline - time.monotonic())  # type: ignore[misc]
    return sum(call.outcome is None for call in calls)


def _goes(call: Call) -> bool:
    assert call.outcome is None, call.result
    return call.feedback is not None and call.feedback.state == "running"


def _tree(machines: list[str]) -> str:
    """Each machine from subtask to subtask, all of them at once."""

    def leaves(name: str) -> str:
        return "".join(LEAF.format(name, record, subtask) for record in RECORDS for subtask in SUBTASKS)

    rows = [
        f"<KeepRunningUntilFailure><Sequence>{leaves(name)}</Sequence></KeepRunningUntilFailure>" for name in machines
    ]
    inside = (
        rows[0]
        if len(rows) == 1
        else f'<Parallel success_threshold="{len(rows)}" failure_threshold="1">{"".join(rows)}</Parallel>'
    )
    return f'<root main_tree_to_execute="M"><BehaviorTree ID="M">{inside}</BehaviorTree></root>'


def main(runs: str, crowds: str) -> None:
    site = load_site()
    environment.enter(site)
    ros = Ros("dispatcher")
    store_records(ros, list(site.file.machines))
    calls = start_all(ros, site, int(runs))
    print("going", flush=True)
    sys.stdin.read()
    begun = press(ros, int(crowds))
    print(json.dumps({"pressed": begun, "left": left(calls)}), flush=True)
    ros.close()


if __name__ == "__main__":
    main(*sys.argv[1:])
