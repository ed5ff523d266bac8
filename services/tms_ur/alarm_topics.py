"""What only alarms need of the site: topics of host agents, and what Prometheus tells.

Rules are judged also while no console is open.
"""

from collections.abc import Iterable
from functools import partial

from std_msgs.msg import Bool

from tms_config.clock import utc_now
from tms_machine.border import standby
from tms_ros.node import Ros
from tms_ur.board import Board
from tms_ur.prometheus import alarms

PERIOD = 1.0  # s: for how long a rule has held is known to that
ASKED = 5.0  # s between two questions to Prometheus


def listen(ros: Ros, machines: Iterable[str], board: Board, prometheus: str) -> None:
    """Keep the board up to date with it; `prometheus`: its address, empty where the site names none."""
    for name in machines:
        ros.subscribe(Bool, standby(name), partial(_on_standby, board, name), latched=True)
    ros.poll_in_thread(PERIOD, board.snapshot, "alarms")
    if prometheus:
        ros.poll_in_thread(ASKED, lambda: board.put_told(alarms(prometheus, utc_now())), "prometheus")


def _on_standby(board: Board, machine: str, message: Bool) -> None:
    board.put_standing_in(machine, message.data)
