"""What the scheduler tells of blackboards: the entries that a node sees, through remaps, and nothing of others."""

import json
from types import SimpleNamespace
from typing import Any

from rcl_interfaces.msg import ParameterType
from rcl_interfaces.srv import GetParameters

from tms_ts import bt
from tms_ts.active_runs import ActiveRuns
from tms_ts.blackboards import Blackboards
from tms_ts.run import Run

TREE = """<root main_tree_to_execute="M">
  <BehaviorTree ID="M"><Sequence>
    <SetBlackboard output_key="count" value="3"/>
    <SubTree ID="S" inner="count"/>
  </Sequence></BehaviorTree>
  <BehaviorTree ID="S"><SetBlackboard output_key="own" value="x"/></BehaviorTree>
</root>"""


def told(boards: Blackboards, *names: str) -> Any:
    (value,) = boards.get(GetParameters.Request(names=list(names)), GetParameters.Response()).values
    return None if value.type == ParameterType.PARAMETER_NOT_SET else json.loads(value.string_value)


def test_a_node_sees_the_entries_of_its_tree() -> None:
    run: Any = SimpleNamespace(facts=SimpleNamespace(run_id="r-1"), log_event=lambda *_: None)
    tree = bt.load(TREE)
    Run.publish_tree(run, tree)
    runs = ActiveRuns()
    runs.add(run)
    boards = Blackboards(runs)
    assert told(boards, "r-1", "0") == {}
    tree.tick()
    inner = next(node.path for node in tree.nodes if node.blackboard is not tree.root.blackboard)
    assert told(boards, "r-1", "0") == {"count": "3"}
    assert told(boards, "r-1", inner)["own"] == "x"
    assert [told(boards, "r-1", "0.9"), told(boards, "r-2", "0"), told(boards)] == [None, None, None]
