"""What the check finds in a tree before anything runs: wrong numbers of children, keys of two types."""

from typing import Any

import pytest

from tms_ts.bt import SUCCESS, InOut, Out, Status, SyncAction, load, registry
from tms_ts.tree_reasons import IfThenElseChildren, KeyOfTwoTypes, NeverWritten, SwitchChildren, WhileDoElseChildren
from unit.tms_ts.trees import document

OK = "<AlwaysSuccess/>"
NUMBER, TEXT, FLAG = (f'<SetLocalBlackboard output_key="k" value="{value}"/>' for value in ("3", "far", "true"))


@pytest.mark.parametrize(
    ("body", "found"),
    [
        (f"<IfThenElse>{OK}</IfThenElse>", IfThenElseChildren(1)),
        (f"<IfThenElse>{OK * 4}</IfThenElse>", IfThenElseChildren(4)),
        (f"<WhileDoElse>{OK * 2}</WhileDoElse>", WhileDoElseChildren(2)),
        (f'<Switch2 variable="1" case_1="1" case_2="2">{OK * 2}</Switch2>', SwitchChildren("Switch2", 3, 2)),
    ],
)
def test_a_wrong_number_of_children_is_a_fault_with_its_line(body: str, found: object) -> None:
    (fault,) = load(document(f"<Sequence>\n{body}\n</Sequence>")).faults
    assert (fault.line, fault.what) == (4, found)


@pytest.mark.parametrize(
    "body",
    [
        f"<IfThenElse>{OK * 2}</IfThenElse>",
        f"<WhileDoElse>{OK * 3}</WhileDoElse>",
        f'<Switch2 variable="1" case_1="1" case_2="2">{OK * 3}</Switch2>',
    ],
)
def test_the_right_number_is_none(body: str) -> None:
    assert not load(document(body)).faults


def warned(*nodes: str) -> list[tuple[int, KeyOfTwoTypes]]:
    loaded = load(document("<Sequence>\n" + "\n".join(nodes) + "\n</Sequence>"))
    return [(line, one) for line, one in loaded.warnings if isinstance(one, KeyOfTwoTypes)]


def test_a_key_that_is_written_with_two_types_is_warned_about_at_the_second() -> None:
    ((line, one),) = warned(NUMBER, FLAG)
    assert (line, one.key, one.line) == (5, "k", 4)
    assert one.type != one.other


def test_a_text_that_comes_first_leaves_the_type_open() -> None:
    assert warned(NUMBER, NUMBER) == warned(TEXT, NUMBER) == []


class Measure(SyncAction):
    """Writes its ports, as a node of somebody else may."""

    __slots__ = ()
    anything: Out[Any]
    total: InOut[int]

    def tick(self) -> Status:
        return SUCCESS


@pytest.mark.parametrize(
    ("ports", "missing"),
    [('anything="k"', False), ('anything="{k}"', False), ('total="{k}"', False), ('total="k"', True), ("", True)],
)
def test_an_output_of_any_node_counts_as_written(ports: str, missing: bool) -> None:
    text = document(f'<Sequence><Counter key="k"/><Measure {ports}/></Sequence>')
    loaded = load(text, registry=registry().extended(Measure))
    assert [what for _, what in loaded.warnings if isinstance(what, NeverWritten)] == (
        [NeverWritten("k", "Counter")] if missing else []
    )
