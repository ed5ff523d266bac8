"""Lines of the journal, those of earlier releases among them."""

import base64

import pytest
from builtin_interfaces.msg import Time
from tms_msg_db.msg import Event, Run

from tms_machine.values import from_parameters, to_parameters
from tms_ros.packing import pack
from tms_ts.journal_entry import of_line, to_line

RUN = Run(run_id="20260131-060000-abcd", task_id=4, description="dig", state="interrupted", machines=["zx200", "ic120"],
          records=["zx200/A"], started_at=Time(sec=5, nanosec=7))  # fmt: skip
# As release 345e2f0 has written this run: it knew no `values`.
EARLIER = (
    b"RAAEAABUAAAAyMDI2MDEzMS0wNjAwMDAtYWJjZAB/AAAEAAAABAAAAGRpZwAMAAAAaW50ZXJydXB0ZWQAAQAAAAAAAAACAAAABgAAAHp4MjAwAAAA"
    b"BgAAAGljMTIwAAAAAQAAAAgAAAB6eDIwMC9BAAUAAAAHAAAAAAAAAAAAAAA="
)


def test_a_line_becomes_its_entry() -> None:
    event = Event(run_id="r", number=7, kind="node", values=to_parameters({"nodes": 3}))
    assert of_line(to_line(type(event), pack(event))) == event
    assert of_line(to_line(type(RUN), pack(RUN))) == RUN
    told = Run(run_id="r", values=to_parameters({"nodes": 3}))
    assert from_parameters(of_line(to_line(type(told), pack(told))).values) == {"nodes": 3}


def test_a_run_of_an_earlier_release_has_no_values() -> None:
    assert of_line(EARLIER) == RUN


@pytest.mark.parametrize(
    "line", [b"V", b"Vnot base64", b"E" + base64.b64encode(b"short"), b"X" + base64.b64encode(b"1234")]
)
def test_a_damaged_line_is_an_error(line: bytes) -> None:
    with pytest.raises((ValueError, RuntimeError)):
        of_line(line)
