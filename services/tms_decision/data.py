"""Plain data: what happens, and what is to be done."""

from dataclasses import dataclass
from typing import Any

from typing_extensions import dataclass_transform


@dataclass_transform(frozen_default=True)
class Data:
    """Base of frozen dataclasses, many of which take one line."""

    def __init_subclass__(cls, **more: Any) -> None:
        super().__init_subclass__(**more)
        dataclass(frozen=True)(cls)


class Event(Data):
    """Something that happens."""


class Effect(Data):
    """Something that is to be done."""
