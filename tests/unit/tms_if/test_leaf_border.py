"""Goals between the forms of LeafNodeBase: no input is lost, and none is made up."""

from types import SimpleNamespace
from typing import Any

import pytest
from tms_msg_if.action import LeafGoal

from tms_if import leaf_border
from tms_if.leaf_border import ToTheirs, to_ours, to_theirs
from tms_machine.reasons import InputsNotTaken

INPUTS = {
    "v6a": ("previous_target_record_name",),
    "v6b": ("read_direction", "blade_hold", "previous_target_record_name"),
}


@pytest.fixture(params=sorted(INPUTS))
def form(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> str:
    """A form of version 6 in place of the one that this process has."""

    class Goal(SimpleNamespace):
        @classmethod
        def get_fields_and_field_types(cls) -> dict[str, str]:
            return dict.fromkeys(("model_name", "record_name", *INPUTS[request.param]), "")

    monkeypatch.setattr(leaf_border, "THEIRS", SimpleNamespace(Goal=Goal))
    return str(request.param)


def theirs(form: str, **given: Any) -> Any:
    empty = {name: False if name == "blade_hold" else "" for name in INPUTS[form]}
    return SimpleNamespace(**{"model_name": "zx200", "record_name": "pose", **empty, **given})


def test_what_they_leave_empty_is_no_input(form: str) -> None:
    assert to_ours(theirs(form)) == LeafGoal.Goal(model_name="zx200", record_name="pose")


def test_their_inputs_reach_us_and_return(form: str) -> None:
    given = {name: True if name == "blade_hold" else "down" for name in INPUTS[form]}
    there_and_back = to_theirs(to_ours(theirs(form, **given)))
    assert vars(there_and_back) == {"model_name": "zx200", "record_name": "pose", **given}


def test_an_input_without_a_field_refuses_our_goal(form: str, monkeypatch: pytest.MonkeyPatch) -> None:
    app: Any = SimpleNamespace(machine="zx200", ros=None, site=None)
    monkeypatch.setattr(leaf_border, "misfit", lambda *_, servers: None)
    peer: Any = SimpleNamespace(ready=lambda: True, name="/zx200/dig")
    relay = ToTheirs(app, "dig", peer)
    down = LeafGoal.Goal(model_name="zx200", record_name="pose?read_direction=down")
    assert relay.accept(down) == (None if form == "v6b" else InputsNotTaken(("read_direction",)))
