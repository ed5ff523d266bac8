"""Values keep their types on the wire."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tms_machine.values import can_travel, from_parameters, to_parameters

INTEGERS = st.integers(-(2**63), 2**63 - 1)
SCALARS = st.one_of(st.booleans(), INTEGERS, st.floats(allow_nan=False), st.text())
ARRAYS = st.one_of(
    st.lists(st.booleans(), min_size=1), st.lists(INTEGERS, min_size=1), st.lists(st.floats(allow_nan=False)),
    st.lists(st.text(), min_size=1),
)  # fmt: skip


@given(st.dictionaries(st.text(min_size=1), st.one_of(SCALARS, ARRAYS), max_size=5))
def test_round_trip(fields: dict[str, object]) -> None:
    back = from_parameters(to_parameters(fields))
    assert back == fields
    assert {name: type(value) for name, value in back.items()} == {n: type(v) for n, v in fields.items()}


@pytest.mark.parametrize("value", [{}, {"a": {"b": [1, 2.5, "x", True]}}, [{"a": 1}, {"a": 1.0}], {"a": [[1], []]}])
def test_a_document_comes_back_as_it_was(value: object) -> None:
    assert repr(from_parameters(to_parameters({"field": value}))) == repr({"field": value})


def test_bytes_that_are_no_document_are_left_out() -> None:
    (parameter,) = to_parameters({"field": {"a": 1}})
    for data in (b"\xff", b"{", b"1"):
        parameter.value.byte_array_value = [bytes([byte]) for byte in data]
        assert from_parameters([parameter]) == {}


def test_a_mixed_array_becomes_doubles() -> None:
    assert from_parameters(to_parameters({"x": [1, 2.5]})) == {"x": [1.0, 2.5]}


@pytest.mark.parametrize(
    "value", [None, {"a": b"x"}, {1: "a"}, [{"a": 1}, 2], [True, 1], [[1]], b"x", ["a", 1], 2**63, [-(2**63) - 1]]
)
def test_what_cannot_travel(value: object) -> None:
    assert not can_travel(value)
    with pytest.raises(TypeError, match="field: a"):
        to_parameters({"field": value})
