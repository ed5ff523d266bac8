"""A subtask declares itself by its signature; records are checked strictly."""

import pytest
from pydantic import ValidationError

from tms_kit.subtask import Machine, Params, Progress, Subtask, subtask
from tms_kit.subtask_server import load
from tms_reason.errors import ConfigError
from tms_reason.validation import explain
from words import words


class Heading(Params):
    target_angle: float


def test_the_signature_is_the_declaration() -> None:
    @subtask(timeout=7)
    def swing(machine: Machine, want: Heading, progress: Progress) -> None: ...

    declared = swing.__dict__["subtask"]
    assert issubclass(declared, Subtask)
    assert (declared.timeout, declared.params) == (7, Heading)


def test_the_second_argument_needs_params() -> None:
    with pytest.raises(TypeError, match="second argument"):

        @subtask(timeout=7)
        def swing(machine: Machine, want: int, progress: Progress) -> None: ...


@pytest.mark.parametrize(
    ("record", "said"),
    [
        ({}, "target_angle: is missing"),
        ({"target_angle": "1.0"}, "target_angle: must be a number"),
        ({"target_angle": True}, "target_angle: must be a number"),
        ({"target_angle": float("nan")}, "target_angle: must be a finite number"),
        ({"target_angle": [1.0]}, "target_angle: must be a number"),
    ],
)
def test_a_record_that_does_not_fit_names_the_field(record: dict[str, object], said: str) -> None:
    with pytest.raises(ValidationError) as caught:
        Heading.model_validate(record)
    assert said in words(explain(caught.value))


def test_an_integer_is_a_number_and_other_fields_do_not_matter() -> None:
    assert Heading.model_validate({"target_angle": 1, "note": "x"}).target_angle == 1.0


def test_a_file_must_hold_one_subtask() -> None:
    with pytest.raises(ConfigError, match="0 subtasks"):
        load("__init__")
