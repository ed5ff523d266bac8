"""What verbs share."""

import json
import math

import pytest
from tms_msg_db.srv import AddTask

from tms_cli import session
from tms_reason.errors import TmsError


def test_a_number_that_json_does_not_have_is_null(capsys: pytest.CaptureFixture[str]) -> None:
    def refuse(word: str) -> None:
        pytest.fail(f"{word} is no JSON")

    session.show_json({"a": math.nan, "b": [1.5, math.inf, -math.inf], "c": ({"d": math.nan}, True, 3, "機械", None)})
    shown = json.loads(capsys.readouterr().out, parse_constant=refuse)
    assert shown == {"a": None, "b": [1.5, None, None], "c": [{"d": None}, True, 3, "機械", None]}


def test_a_text_that_ros_would_cut_is_not_sent() -> None:
    class Ros:
        def call(self, *_: object) -> None:
            pytest.fail("it was sent")

    with pytest.raises(TmsError, match=r"^/tms/db/add_task: description 'a\\x00b' holds the control character U\+0000"):
        session.call(Ros(), AddTask, "/tms/db/add_task", task_sequence="<root/>", description="a\0b")  # type: ignore[arg-type]
