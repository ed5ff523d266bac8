"""A reason as the API sends it: code and arguments for programs, and its texts in every language for people."""

import math
from functools import lru_cache
from typing import Any

from pydantic import BaseModel, ConfigDict, Field

from tms_reason import texts, wire
from tms_reason.errors import TmsError
from tms_reason.reason import Foreign, Reason

KEPT = 1000  # views; every state of a machine carries the same lines again


class ViewPart(BaseModel):
    """Base of the parts of a view."""

    model_config = ConfigDict(frozen=True, extra="forbid")


class Texts(ViewPart):
    """The same in both languages."""

    en: str
    ja: str


class Action(ViewPart):
    """What an operator can do about a reason."""

    name: str = Field(description="for programs, for example rearm")
    command: str = Field(description="of a shell; empty where only hands help")
    args: dict[str, Any] = Field(description="what it is done to: the arguments of the reason that it helps against")
    text: Texts


class ReasonView(ViewPart):
    """Why something is as it is."""

    code: str = Field(description="for programs, for example TASK_MISSING")
    args: dict[str, Any] = Field(description="by name; numbers in SI units; a cause is {code, args}")
    text: Texts = Field(description="for people")
    details: Texts = Field(description="for whoever looks for the fault; may be empty")
    action: Action | None = Field(description="null: nothing that an operator can do")


@lru_cache(maxsize=KEPT)
def of_line(line: str) -> ReasonView | None:
    """The view of a reason as a message carries it; None for an empty string."""
    reason = wire.of(line)
    return None if reason is None else view(reason)


def view(reason: Reason) -> ReasonView:
    """The view of a reason."""
    return ReasonView(
        code=reason.code,
        args=_finite(wire.to_data(reason)["args"]),
        text=Texts(en=texts.text(reason, "en"), ja=texts.text(reason, "ja")),
        details=Texts(en=texts.details(reason, "en"), ja=texts.details(reason, "ja")),
        action=_action(reason),
    )


def of_error(error: TmsError) -> ReasonView:
    """The view of an error; where the reason is a foreign text, the view has the error's code."""
    shown = view(error.reason)
    return shown.model_copy(update={"code": error.code}) if isinstance(error.reason, Foreign) else shown


def _action(reason: Reason) -> Action | None:
    found = texts.remedy_of(reason)
    if found is None:
        return None
    wanted, command = found
    remedy = type(wanted).remedy
    assert remedy is not None, "its remedy was found"
    text = Texts(en=texts.remedy_text(wanted, "en"), ja=texts.remedy_text(wanted, "ja"))
    return Action(name=remedy.name, command=command, args=_finite(wire.to_data(wanted)["args"]), text=text)


def _finite(value: Any) -> Any:
    """Replace numbers that JSON does not have: infinite ones and NaN."""
    if isinstance(value, dict):
        return {name: _finite(one) for name, one in value.items()}
    if isinstance(value, list):
        return [_finite(one) for one in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
