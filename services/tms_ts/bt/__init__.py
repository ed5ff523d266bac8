"""A behaviour-tree engine that runs Groot 1 files tick for tick like BehaviorTree.CPP 3.8.8.

It knows no ROS, no database and no machine: leaf nodes reach those through `tms_ts.world`.
"""

from tms_ts.bt.check_template import TemplateReport, check_template
from tms_ts.bt.control import Control
from tms_ts.bt.convert import MISSING, UInt
from tms_ts.bt.decorator import Decorator
from tms_ts.bt.errors import TickError, TreeError
from tms_ts.bt.expand import Templates
from tms_ts.bt.leaf import Condition, CoroAction, PlainAction, StatefulAction, SyncAction
from tms_ts.bt.load import CheckReport, check, load
from tms_ts.bt.node import Node
from tms_ts.bt.palette import palette
from tms_ts.bt.ports import Direction, In, InOut, Out, Port
from tms_ts.bt.py_trees_leaf import PyTreesLeaf
from tms_ts.bt.registry import Registry, node, registry
from tms_ts.bt.status import FAILURE, IDLE, RUNNING, SUCCESS, NodeType, Status
from tms_ts.bt.tree import LeafGoal, Tree

__all__ = [
    "FAILURE",
    "IDLE",
    "MISSING",
    "RUNNING",
    "SUCCESS",
    "CheckReport",
    "Condition",
    "Control",
    "CoroAction",
    "Decorator",
    "Direction",
    "In",
    "InOut",
    "LeafGoal",
    "Node",
    "NodeType",
    "Out",
    "PlainAction",
    "Port",
    "PyTreesLeaf",
    "Registry",
    "StatefulAction",
    "Status",
    "SyncAction",
    "TemplateReport",
    "Templates",
    "TickError",
    "Tree",
    "TreeError",
    "UInt",
    "check",
    "check_template",
    "load",
    "node",
    "palette",
    "registry",
]
