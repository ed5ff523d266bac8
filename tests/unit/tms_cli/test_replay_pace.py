"""When messages of a recording are due, and their stamps."""

from typing import Any

import pytest
from geometry_msgs.msg import PointStamped
from nav_msgs.msg import Odometry
from std_msgs.msg import Float64

from tms_cli.replay.pace import Pace
from tms_cli.replay.stamps import Stamps
from tms_machine.sensing import Input
from tms_ros.packing import pack, unpack

SECOND = 1_000_000_000  # ns
BEGAN = 1_000 * SECOND  # of the recording


def test_the_pace() -> None:
    now = [100.0]
    pace = Pace(BEGAN, 20.0, clock=lambda: now[0], wall=lambda: now[0] + 1e6)
    assert pace.wait(BEGAN + 40 * SECOND) == pytest.approx(2.0)
    now[0] += 2.0
    assert pace.wait(BEGAN + 40 * SECOND) == 0.0
    assert pace.moment() == BEGAN + 40 * SECOND
    first = pace.stamp("/a", 7 * SECOND, BEGAN + 40 * SECOND)
    assert first == pytest.approx((1e6 + 102.0) * SECOND, abs=1000), "the first stamp is now"
    assert pace.stamp("/a", 9 * SECOND, BEGAN + 41 * SECOND) - first == 2 * SECOND // 20
    now[0] += 10.0  # this PC was away: what is late is not made up for in a burst
    assert pace.wait(BEGAN + 60 * SECOND) == 0.0
    assert pace.wait(BEGAN + 80 * SECOND) == pytest.approx(1.0)
    assert pace.stamp("/a", 27 * SECOND, BEGAN + 60 * SECOND) == pytest.approx((1e6 + 112.0) * SECOND, abs=1000)


@pytest.mark.parametrize(
    ("kind", "stamp"), [(PointStamped, None), (Odometry, "header.stamp"), (Float64, "data")], ids=lambda each: str(each)
)
def test_stamps_are_replaced_and_nothing_else(kind: Any, stamp: str | None) -> None:
    given = Input.model_validate({"topic": "/t", "type": "a/msg/B", "stamp": stamp})
    stamps = Stamps(given, kind)
    message = kind()
    data = stamps.replaced(pack(message), message, 1_700_000_000 * SECOND + 5)
    found = unpack(data, kind)
    assert stamps.read(found) == pytest.approx(1_700_000_000 * SECOND + 5, abs=300)
    assert unpack(stamps.replaced(data, found, 0), kind) == kind()  # bytes between fields are anything
