"""How runs are shown: the tree as lines, changes on a pipe, what the end of a run tells."""

import pytest
from tms_msg_rc.msg import MachineState
from tms_msg_ts.action import ExecuteTask
from tms_msg_ts.msg import NodeStatus

from tms_cli import live
from tms_cli.live import FAILURE, IDLE, RUNNING, SUCCESS

TREE = [(1, 0, "Sequence"), (2, 1, "LeafNodeZx200"), (3, 1, "LeafNodeZx200")]
GOALS = [("Sequence", ""), ("LeafNodeZx200", "dig"), ("LeafNodeZx200", "release")]


def feedback(*statuses: tuple[int, int, str], state: str = "running", reason: str = "") -> ExecuteTask.Feedback:
    """A message about some nodes: (uid, status, reason)."""
    known = {uid: (parent, kind) for uid, parent, kind in TREE}
    nodes = [
        NodeStatus(uid=uid, parent=known[uid][0], name=known[uid][1], type=known[uid][1], status=status, reason=why)
        for uid, status, why in statuses
    ]
    return ExecuteTask.Feedback(run_id="r1", state=state, reason=reason, nodes=nodes)


@pytest.fixture
def view() -> live.View:
    ticks = iter(range(1000))
    made = live.View(1, "one cycle", GOALS, clock=lambda: float(next(ticks)))
    made.received(feedback((1, RUNNING, ""), (2, RUNNING, "MOVING 5 %"), (3, IDLE, "")))
    return made


def texts(view: live.View, most: int = 40) -> list[str]:
    return [line for _, line in live.tree_rows(view, most)]


def test_the_tree_is_indented_with_states_goals_and_the_running_leafs_reason(view: live.View) -> None:
    assert texts(view) == [
        "▶ Sequence",
        "  ▶ LeafNodeZx200  dig  — MOVING 5 %",
        "  · LeafNodeZx200  release",
    ]
    assert [status for status, _ in live.tree_rows(view)] == [RUNNING, RUNNING, IDLE]


def test_later_messages_hold_changes_only(view: live.View) -> None:
    changed = view.received(feedback((2, SUCCESS, ""), (3, RUNNING, "")))
    assert [(node.uid, node.status) for node in changed] == [(2, SUCCESS), (3, RUNNING)]
    assert len(view.nodes) == 3


def test_several_changes_of_one_node_in_a_message_are_all_told(view: live.View) -> None:
    changed = view.received(feedback((2, SUCCESS, ""), (2, IDLE, "")))
    assert [node.status for node in changed] == [SUCCESS, IDLE]
    assert texts(view)[1].strip().startswith("✔"), "an idle node still tells how it ended"


def test_an_unknown_tree_is_shown_without_goals() -> None:
    other = live.View(1, "", [("Fallback", "")])
    other.received(feedback((1, RUNNING, ""), (2, IDLE, "")))
    assert texts(other) == ["▶ Sequence", "  · LeafNodeZx200"]


def test_nodes_whose_parent_was_never_heard_of_are_still_shown() -> None:
    lonely = live.View(1)
    lonely.received(feedback((3, FAILURE, "out of reach")))
    assert texts(lonely) == ["✘ LeafNodeZx200  — out of reach"]


def test_success_of_a_sequence_tells_the_success_of_its_last_leaf(view: live.View) -> None:
    view.received(feedback((2, SUCCESS, ""), (3, RUNNING, "")))
    view.received(feedback((1, IDLE, ""), (2, IDLE, ""), (3, IDLE, "")))
    assert [node.uid for node in view.close("success")] == [3, 1]
    assert all(status == SUCCESS for status, _ in live.tree_rows(view))


def test_a_cancelled_run_claims_no_success(view: live.View) -> None:
    view.received(feedback((1, IDLE, ""), (2, IDLE, ""), (3, IDLE, "")))
    assert view.close("cancelled") == []
    assert [status for status, _ in live.tree_rows(view)] == [IDLE, IDLE, IDLE]


def test_a_long_tree_is_cut_around_the_part_that_works() -> None:
    long = live.View(1)
    nodes = [NodeStatus(uid=1, type="Sequence", name="Sequence", status=RUNNING)]
    nodes += [NodeStatus(uid=n, parent=1, type="Leaf", name=f"leaf{n}", status=IDLE) for n in range(2, 200)]
    nodes[150].status = RUNNING
    long.received(ExecuteTask.Feedback(run_id="r", nodes=nodes))
    shown = texts(long, most=11)
    assert len(shown) == 11
    assert any("leaf151" in line for line in shown)


def test_a_deep_tree_does_not_recurse() -> None:
    deep = live.View(1)
    nodes = [NodeStatus(uid=n, parent=n - 1, type="Inverter", name="Inverter") for n in range(1, 5001)]
    deep.received(ExecuteTask.Feedback(run_id="r", nodes=nodes))
    assert sum(1 for _ in deep.rows()) == 5000


def test_joint_angles_in_both_units() -> None:
    state = MachineState(machine="zx200", moving=True, joint_names=["swing_joint"], positions=[3.14159265])
    assert live.joint_lines({"zx200": state}) == ["zx200: moving", "  swing_joint           3.142 rad    180.0°"]
    lost = MachineState(machine="zx200", reason="no joint states")
    assert live.joint_lines({"zx200": lost}) == ["zx200: not ready: no joint states"]


def test_a_pipe_gets_one_line_per_change_and_no_percentages(capsys, view: live.View) -> None:
    lines = live.Lines()
    for reason in ("MOVING 5 %", "MOVING 6 %", "MOVING 7 %"):
        lines.show(view, view.received(feedback((2, RUNNING, reason), reason=reason)))
    lines.show(view, view.received(feedback((2, SUCCESS, ""), (3, RUNNING, "sending"), reason="sending")))
    lines.show(view, view.received(feedback((1, IDLE, ""), (2, IDLE, ""), (3, IDLE, ""))))
    shown = [line[11:] for line in capsys.readouterr().out.splitlines()]
    assert shown == [
        "run r1: running",
        "         MOVING 5 %",
        "success  LeafNodeZx200  dig",
        "running  LeafNodeZx200  release  — sending",
    ]


def test_with_json_the_lines_go_to_stderr(capsys, view: live.View) -> None:
    live.display(as_json=True).show(view, [])
    out, err = capsys.readouterr()
    assert out == ""
    assert "run r1" in err


@pytest.mark.parametrize(
    ("seconds", "text"), [(0.25, "0.2 s"), (59, "59.0 s"), (600, "10 min"), (7300, "2 h"), (200_000, "2 d")]
)
def test_durations_read_well(seconds: float, text: str) -> None:
    assert live.duration(seconds) == text
