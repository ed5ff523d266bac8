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


def test_a_mixed_array_becomes_doubles() -> None:
    assert from_parameters(to_parameters({"x": [1, 2.5]})) == {"x": [1.0, 2.5]}


@pytest.mark.parametrize("value", [None, {"a": 1}, [True, 1], [[1]], b"x", ["a", 1], 2**63, [-(2**63) - 1]])
def test_what_cannot_travel(value: object) -> None:
    assert not can_travel(value)
    with pytest.raises(TypeError, match="field: a"):
        to_parameters({"field": value})
