"""The one check of names and texts from outside."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import BaseModel, ValidationError
from tms_msg_db.srv import SetParameter

from tms_config.names import Name, Text, check_sent, check_text, flaw
from tms_machine.values import to_parameters
from tms_reason.errors import TmsError


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("", "is empty"),
        (" \t", "is empty"),
        ("ev\0il", "holds the control character U+0000"),
        ("a\nb", "holds the control character U+000A"),
        ("a\x1b[31m", "holds the control character U+001B"),
        ("a\x7f", "holds the control character U+007F"),
        ("a\x85b", "holds the control character U+0085"),
        ("a\u2028b", "holds the control character U+2028"),
        ("a\ud800", "holds the control character U+D800"),
        ("a\u202eb", "holds a character that nobody sees"),
        ("a\u200bb", "holds a character that nobody sees"),
        (" a", "begins or ends with a blank"),
        ("a ", "begins or ends with a blank"),
        ("a" * 201, "has more than 200 letters"),
    ],
)
def test_a_name_that_is_none(name: str, why: str) -> None:
    assert flaw(name) == why


@pytest.mark.parametrize("name", ["zx200", "掘削 位置", "a b", "é", "a" * 200, "target_dig-1.5/α"])
def test_a_name_that_is_one(name: str) -> None:
    assert flaw(name) is None


def test_a_text_may_hold_anything_that_can_be_seen() -> None:
    check_text("the description", "掘削、積込\u3000（試験） ")
    with pytest.raises(TmsError, match=r"^the description holds the control character U\+0000: remove it$"):
        check_text("the description", "dig\0here")


@given(st.text(max_size=300))
def test_whatever_passes_arrives_whole(name: str) -> None:
    """As a C string, and as a line of a log or a list."""
    if flaw(name) is None:
        assert name.encode().split(b"\0")[0].decode() == name
        assert name.splitlines() == [name] and name.strip() == name


@pytest.mark.parametrize(
    ("fields", "field"),
    [
        ({"record_name": "ev\0il"}, "record_name 'ev\\x00il'"),
        ({"description": "\0"}, "description '\\x00' holds the control character U+0000: remove it"),
        ({"description": "\udcff"}, "description '\\udcff' holds the control character U+DCFF: remove it"),
        ({"remove": ["a", "b\0c"]}, "remove 'b\\x00c'"),
        ({"values": to_parameters({"a\0b": 1})}, "name 'a\\x00b'"),
        ({"values": to_parameters({"a": "x\0y"})}, "string_value 'x\\x00y'"),
        ({"values": to_parameters({"a": ["x", "\0"]})}, "string_array_value"),
    ],
)
def test_a_message_that_would_arrive_cut_is_not_sent(fields: dict[str, object], field: str) -> None:
    check_sent("set_parameter", SetParameter.Request(record_name="good", values=to_parameters({"a": "b", "n": [1.0]})))
    with pytest.raises(TmsError) as caught:
        check_sent("set_parameter", SetParameter.Request(**fields))
    assert str(caught.value).startswith(f"set_parameter: {field}")
    assert "holds the control character U+" in str(caught.value)


def test_what_the_api_takes() -> None:
    class Given(BaseModel):
        name: Name = "a"
        text: Text = ""

    Given(name="掘削", text="")
    for wrong in ({"name": "ev\0il"}, {"name": ""}, {"text": "a\nb"}):
        with pytest.raises(ValidationError):
            Given.model_validate(wrong)
