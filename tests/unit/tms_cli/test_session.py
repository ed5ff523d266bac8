"""What verbs share."""

import json
import math

import pytest

from tms_cli import session


def test_a_number_that_json_does_not_have_is_null(capsys: pytest.CaptureFixture[str]) -> None:
    def refuse(word: str) -> None:
        pytest.fail(f"{word} is no JSON")

    session.show_json({"a": math.nan, "b": [1.5, math.inf, -math.inf], "c": ({"d": math.nan}, True, 3, "機械", None)})
    shown = json.loads(capsys.readouterr().out, parse_constant=refuse)
    assert shown == {"a": None, "b": [1.5, None, None], "c": [{"d": None}, True, 3, "機械", None]}
