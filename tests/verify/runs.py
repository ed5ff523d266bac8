"""The run that succeeds, as the paper verifies it, and runs that fail."""

from __future__ import annotations

import statistics
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from tms_ros.goals import Outcome
from verify import colours, history, sensing, stops
from verify.place import MACHINE, until
from verify.stage import LIMIT, Stage
from verify.truth import JOINTS, travel

if TYPE_CHECKING:
    from verify.groot import Viewer

SUBTASKS = ("subtask_zx200_change_pose", "subtask_zx200_excavate_simple", "subtask_zx200_release_simple")
PROCESSES = {f"{MACHINE}:{name}" for name in SUBTASKS}
FIRST, DIG = "initial_pose", sensing.RECORD
SWING_OFF = 0.03  # rad that the true swing may be off where it digs
MOVED = 0.1  # rad that each joint must have gone
READS = 20


def success(stage: Stage) -> None:
    """The whole task, while sensing renews the place to dig."""
    feedback = _feedback(stage)
    with stage.watched() as (viewer, run, pressed):
        viewer.wait(FIRST, colours.ORANGE, LIMIT)
        delays = [stage.sensing.renew(place) for place in sensing.PLACES]
        refused = stage.place.mesh.tms("param", "set", f"{MACHINE}/{FIRST}", "boom_joint=-1.0", expect=None).returncode
        viewer.wait(DIG, colours.ORANGE, LIMIT)
        for _ in range(READS):
            stage.sensing.read()
    events, outcome = stage.events(run), stage.outcome(run)
    book = stage.book
    book.check(6, f"start button: the run had begun {pressed * 1000:.0f} ms after the press", bool(run))
    book.check(
        5, f"the panel asked for task {stage.task}, task {outcome['task_id']} ran", outcome["task_id"] == stage.task
    )
    _dynamic(stage, viewer, delays, refused)
    _goals(stage, events, feedback)
    _seen(stage, viewer, outcome)


def _feedback(stage: Stage) -> list[Any]:
    """Fills with the feedback of all subtasks while they work."""
    from tms_msg_ts.action import LeafNodeBase

    found: list[Any] = []
    for name in SUBTASKS:
        topic = f"/{MACHINE}/{name}/_action/feedback"
        stage.ros.subscribe(LeafNodeBase.Impl.FeedbackMessage, topic, found.append, depth=100)
    return found


def first(stage: Stage) -> None:
    """The first run, which starts the subtasks; it is stopped at its first leaf, which has the longest way now."""
    before = stage.place.running() & PROCESSES
    events = stage.events(stops.at_leaf(stage, FIRST))
    started = stage.place.running() & PROCESSES
    sent = next(history.at(event) for event in events if event["kind"] == "goal")
    ready = f"{len(started)} after it; the first goal was sent {sent - history.at(events[0]):.1f} s after its begin"
    stage.book.check(
        5, f"{len(before)} of {len(PROCESSES)} subtasks ran before the first run, {ready}", started == PROCESSES
    )


def _dynamic(stage: Stage, viewer: Viewer, delays: Sequence[float], refused: int) -> None:
    usual, slowest, soon = (seconds * 1000 for seconds in (statistics.median(delays), max(delays), sensing.SOON))
    told = (
        f"{len(delays)} places renewed during the run, all readable, after {usual:.0f} ms (median, allowed {soon:.0f})"
    )
    stage.book.check(11, f"{told}, at most {slowest:.0f} ms", usual < soon)
    ended = next(change.stamp for change in viewer.changes if (change.node, change.new) == (DIG, colours.GREEN))
    swing = stage.truth.since(ended)[0].positions["swing_joint"]
    wanted = sensing.swing(stage.place, *sensing.PLACES[-1])
    told = f"it dug at a true swing of {swing:.3f} rad, the last place needs {wanted:.3f} rad (allowed {SWING_OFF} off)"
    stage.book.check(11, told, abs(swing - wanted) < SWING_OFF)
    stage.book.check(11, f"a change of a static record during the run: exit code {refused} (refused)", refused == 1)


def _goals(stage: Stage, events: Sequence[history.Event], feedback: Sequence[Any]) -> None:
    from tms_msg_ts.action import LeafNodeBase

    goals = [event for event in events if event["kind"] == "goal"]
    stage.book.check(8, f"{len(goals)} reports of goals: each of 4 sent, accepted, succeeded", len(goals) == 12)
    asked = len({bytes(one.goal_id.uuid) for one in feedback})
    stage.book.check(8, f"{len(feedback)} feedback messages of {asked} goals", asked == 4)
    peer = stage.ros.peer(LeafNodeBase, f"/{MACHINE}/{SUBTASKS[0]}")
    peer.wait_ready(LIMIT)
    call = peer.send(LeafNodeBase.Goal(model_name=MACHINE, record_name="no_such_record"))
    call.wait_for(lambda: call.outcome is not None, LIMIT)
    stage.book.check(8, f"a goal with a record that does not exist: {call.outcome}", call.outcome is Outcome.REJECTED)
    stage.book.note(8, f"the record was read {READS} times while a leaf worked")


def _seen(stage: Stage, viewer: Viewer, outcome: dict[str, Any]) -> None:
    wrong = colours.wrong_of_success(viewer.changes, viewer.shape)
    nodes, delay = len(viewer.shape.parents), viewer.delay() * 1000
    told = (
        f"{nodes} nodes grey, orange, green in their order; {len(viewer.changes)} changes, at most {delay:.0f} ms late"
    )
    stage.book.note(4, told, wrong)
    stage.book.note(9, f"success: {len(viewer.shape.leaves)} goals were RUNNING, then SUCCESS", wrong)
    samples = stage.truth.since(viewer.changes[0].stamp)
    ways = {
        name: max(one.positions[name] for one in samples) - min(one.positions[name] for one in samples)
        for name in JOINTS
    }
    moved = ", ".join(f"{name} {way:.2f}" for name, way in ways.items())
    stage.book.check(
        12, f"OperaSim-PhysX (its stand-in): true ways of the joints in rad: {moved}", min(ways.values()) > MOVED
    )
    seconds = viewer.changes[-1].stamp - viewer.changes[0].stamp
    told = (
        f"{outcome['state']} after {seconds:.1f} s, true motion up to {travel(samples):.2f} rad, {nodes} nodes in Groot"
    )
    stage.book.check(13, told, outcome["state"] == "success" and not wrong)


def failure(stage: Stage) -> None:
    """Sensing gives a place that the bucket cannot reach: the leaf fails, and with it the tree."""
    with stage.watched() as (viewer, run, _):
        viewer.wait(FIRST, colours.ORANGE, LIMIT)
        stage.sensing.renew(sensing.UNREACHABLE)
    stage.sensing.renew(sensing.PLACES[-1])
    _failed(stage, viewer, run, DIG, "aborted: a place out of reach")


def cancelled_goal(stage: Stage) -> None:
    """Somebody else cancels the goal of a leaf."""
    from action_msgs.srv import CancelGoal

    service = f"/{MACHINE}/{SUBTASKS[1]}/_action/cancel_goal"
    until(lambda: stage.ros.has_service(CancelGoal, service), LIMIT, service)
    call = stage.ros.call
    viewer, run, _ = stage.while_it_works(DIG, lambda _: call(CancelGoal, service, CancelGoal.Request(), LIMIT))
    _failed(stage, viewer, run, DIG, "cancelled by another client")


def _failed(stage: Stage, viewer: Viewer, run: str, leaf: str, why: str) -> None:
    state = stage.outcome(run)["state"]
    wrong = colours.wrong_of_failure(viewer.changes, viewer.shape, leaf)
    wrong += [] if state == "failure" else [f"the run ended as {state}"]
    red = [node for node in viewer.shape.parents if colours.RED in colours.of(viewer.changes, node)]
    stage.book.note(9, f"{why}: FAILURE of {', '.join(red)}; outcome {state}", wrong)
