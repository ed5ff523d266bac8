"""The one check of names and texts from outside."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import BaseModel, ValidationError
from tms_msg_db.srv import SetParameter

from tms_machine.values import to_parameters
from tms_reason.errors import TmsError
from tms_reason.names import Name, Text, check_sent, check_text, name_flaw
from tms_reason.reason import Reason
from tms_reason.reasons import BadText, ControlLetter, EmptyName, HiddenLetter, LongName, OuterBlank


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("", EmptyName()),
        (" \t", EmptyName()),
        ("ev\0il", ControlLetter("U+0000")),
        ("a\nb", ControlLetter("U+000A")),
        ("a\x1b[31m", ControlLetter("U+001B")),
        ("a\x7f", ControlLetter("U+007F")),
        ("a\x85b", ControlLetter("U+0085")),
        ("a\u2028b", ControlLetter("U+2028")),
        ("a\ud800", ControlLetter("U+D800")),
        ("a\u202eb", HiddenLetter()),
        ("a\u200bb", HiddenLetter()),
        (" a", OuterBlank()),
        ("a ", OuterBlank()),
        ("a" * 201, LongName(200)),
    ],
)
def test_a_name_that_is_none(name: str, why: Reason) -> None:
    assert name_flaw(name) == why


@pytest.mark.parametrize("name", ["zx200", "掘削 位置", "a b", "é", "a" * 200, "target_dig-1.5/α"])
def test_a_name_that_is_one(name: str) -> None:
    assert name_flaw(name) is None


def test_a_text_may_hold_anything_that_can_be_seen() -> None:
    check_text("the description", "掘削、積込\u3000（試験） ")
    with pytest.raises(TmsError) as caught:
        check_text("the description", "dig\0here")
    assert caught.value.reason == BadText("the description", "'dig\\x00here'", ControlLetter("U+0000"))


@given(st.text(max_size=300))
def test_whatever_passes_arrives_whole(name: str) -> None:
    """As a C string, and as a line of a log or a list."""
    if name_flaw(name) is None:
        assert name.encode().split(b"\0")[0].decode() == name
        assert name.splitlines() == [name] and name.strip() == name


@pytest.mark.parametrize(
    ("fields", "field", "value", "letter"),
    [
        ({"record_name": "ev\0il"}, "record_name", "'ev\\x00il'", "U+0000"),
        ({"description": "\0"}, "description", "'\\x00'", "U+0000"),
        ({"description": "\udcff"}, "description", "'\\udcff'", "U+DCFF"),
        ({"remove": ["a", "b\0c"]}, "remove", "'b\\x00c'", "U+0000"),
        ({"values": to_parameters({"a\0b": 1})}, "name", "'a\\x00b'", "U+0000"),
        ({"values": to_parameters({"a": "x\0y"})}, "string_value", "'x\\x00y'", "U+0000"),
        ({"values": to_parameters({"a": ["x", "\0"]})}, "string_array_value", "'\\x00'", "U+0000"),
    ],
)
def test_a_message_that_would_arrive_cut_is_not_sent(
    fields: dict[str, object], field: str, value: str, letter: str
) -> None:
    check_sent("set_parameter", SetParameter.Request(record_name="good", values=to_parameters({"a": "b", "n": [1.0]})))
    with pytest.raises(TmsError) as caught:
        check_sent("set_parameter", SetParameter.Request(**fields))
    assert caught.value.reason == BadText(f"set_parameter: {field}", value, ControlLetter(letter))


def test_what_the_api_takes() -> None:
    class Given(BaseModel):
        name: Name = "a"
        text: Text = ""

    Given(name="掘削", text="")
    for wrong in ({"name": "ev\0il"}, {"name": ""}, {"text": "a\nb"}):
        with pytest.raises(ValidationError):
            Given.model_validate(wrong)
