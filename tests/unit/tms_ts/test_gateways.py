"""Which of the gateways' news belong to a run."""

import pytest
from builtin_interfaces.msg import Time
from tms_msg_rc.msg import StopReceipt

from tms_ts.gateways import Holder


@pytest.mark.parametrize(
    ("run", "at", "concerns"),
    [
        (7, 100, True),
        (7, 99, True),  # by the gateway's clock, which is not ours
        (6, 101, False),  # of an earlier run, told again by a gateway that has just started
        (0, 101, True),  # before the gateway heard that a run holds the machine
        (0, 99, False),  # of a machine that nobody held, told again
    ],
)
def test_a_run_hears_of_its_own_stops_only(run: int, at: int, concerns: bool) -> None:
    holder = Holder(7, (100, 0), lambda *_: None, lambda _: None, lambda: True)
    assert holder.concerns(StopReceipt(run=run, stamp=Time(sec=at, nanosec=1))) is concerns
