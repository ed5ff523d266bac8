"""A reason as data: both texts, what helps, and numbers that JSON has."""

import math

from rcl_interfaces.msg import Parameter
from tms_msg_db.msg import Event

from tms_reason import wire
from tms_reason.errors import TmsError
from tms_reason.quantities import Metres
from tms_reason.reason import Foreign, Reason
from tms_reason.remedies import REARM
from tms_ur import export, messages
from tms_ur.reason_view import of_error, of_line, view
from tms_ur.reasons import BadValue, MachineSilent, NotOfType


class MadeUpLatch(Reason, text="{machine} is latched", action=REARM, details="/{machine}/state at {x}"):
    machine: str
    x: Metres


class MadeUpBusy(Reason, text="task {task}: {cause}"):
    task: int
    cause: Reason


def test_a_reason_with_its_action() -> None:
    shown = of_line(wire.to_line(MadeUpLatch("zx200", 1.5)))
    assert shown is not None
    assert (shown.code, shown.args) == ("MADE_UP_LATCH", {"machine": "zx200", "x": 1.5})
    assert (shown.text.en, shown.details.en) == ("zx200 is latched", "/zx200/state at 1.50 m")
    assert shown.action is not None
    assert (shown.action.name, shown.action.command) == ("rearm", "tms rearm zx200")
    assert shown.action.text.ja != shown.action.text.en


def test_the_action_of_a_cause_comes_with_the_arguments_of_the_cause() -> None:
    shown = view(MadeUpBusy(4, MadeUpLatch("zx200", 0.0)))
    assert shown.text.en == "task 4: zx200 is latched"
    assert shown.action is not None
    assert shown.action.args["machine"] == "zx200"


def test_both_languages() -> None:
    shown = view(BadValue("a", "'x'", NotOfType("int")))
    assert (shown.text.en, shown.text.ja) == ("a: 'x': this is no int", "a: 'x': int ではありません")
    assert shown.action is None


def test_numbers_that_json_has_not_are_null() -> None:
    assert view(MachineSilent("zx200:rc", math.inf)).args == {"process": "zx200:rc", "age": None}


def test_words_of_a_service_without_reasons() -> None:
    assert of_line("") is None
    shown = of_line("zx200 is in run r-1")
    assert shown is not None
    assert shown.text.en == shown.text.ja == "zx200 is in run r-1"
    assert of_error(TmsError(Foreign("zx200 is in run r-1"), "MACHINE_BUSY")).code == "MACHINE_BUSY"
    assert of_error(TmsError(NotOfType("int"))).code == "NOT_OF_TYPE"


def test_a_journal_keeps_its_lines_as_they_are_stored() -> None:
    """The hashes of the audit cover them."""
    line = wire.to_line(MadeUpLatch("zx200", 1.5))
    values: list[Parameter] = []
    stored = [Event(number=number, text=text, values=values) for number, text in enumerate((line, "mina from pc"), 1)]
    events = list(map(messages.event, stored))
    assert [one.text for one in events] == [line, "mina from pc"]
    assert [one.reason.code if one.reason else None for one in events] == ["MADE_UP_LATCH", None]
    table = export.as_csv("r-1", events).decode("utf-8-sig").splitlines()
    assert [row.rpartition(",")[2] for row in table[1:]] == ["zx200 is latched", "mina from pc"]
