"""A reason: a code with typed arguments, declared once with its text and with what an operator can do about it.

    class GatewayLost(Reason, text="the gateway of {machine} is lost", action=RESTART_GATEWAY):
        machine: str

The class name gives the code (`GATEWAY_LOST`), the annotations its arguments, with units (`Seconds`, see
quantities.py); an argument may be a reason itself, or a tuple of reasons or texts. `text` is the English text and the
key of the Japanese one (locale/ja/*.po). `details` is shown only on request:
names of topics, errors of a system. No argument is called text, code, details, remedy, parameters or args.
Every package declares its reasons in a module `reasons.py`, one line a reason; those of trees are in tree_reasons.py.
"""

import inspect
import re
from dataclasses import FrozenInstanceError
from typing import Any, ClassVar, TypeVar

from typing_extensions import dataclass_transform

from tms_reason.remedies import Remedy

R = TypeVar("R", bound="Reason")
WORD = re.compile(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])")


@dataclass_transform(frozen_default=True)
class Reason:
    """Base of all reasons: frozen, equal when code and arguments are.

    Used like a frozen dataclass, but none: the standard library compiles six methods for each one, and a process that
    received a reason of another service for the first time stood still for half a second to make some 600 of them.
    """

    code: ClassVar[str] = ""
    text: ClassVar[str] = ""
    details: ClassVar[str] = ""
    remedy: ClassVar[Remedy | None] = None
    parameters: ClassVar[tuple[str, ...]] = ()  # of its arguments

    def __init_subclass__(
        cls, *, text: str, action: Remedy | None = None, details: str = "", code: str = "", **more: Any
    ) -> None:
        super().__init_subclass__(**more)
        cls.parameters = (*cls.parameters, *inspect.get_annotations(cls))
        cls.code = code or WORD.sub("_", cls.__name__).upper()
        cls.text, cls.details, cls.remedy = text, details, action
        known = REGISTRY.setdefault(cls.code, cls)
        if (known.__module__, known.__qualname__) != (cls.__module__, cls.__qualname__):
            raise TypeError(f"{cls.__module__} and {known.__module__} both declare the reason {cls.code}")

    def __init__(self, *values: Any, **named: Any) -> None:
        given = dict(zip(self.parameters, values, strict=False)) | named
        if len(given) != len(values) + len(named) or given.keys() != set(self.parameters):
            raise TypeError(f"{type(self).__name__} takes {', '.join(self.parameters) or 'no arguments'}")
        self.__dict__.update((name, given[name]) for name in self.parameters)

    def __setattr__(self, name: str, value: object) -> None:
        raise FrozenInstanceError(f"cannot assign to field {name!r}")

    def __eq__(self, other: object) -> bool:
        return self.__dict__ == other.__dict__ if type(other) is type(self) else NotImplemented

    def __hash__(self) -> int:
        return hash((type(self), *self.__dict__.values()))

    @property
    def args(self) -> dict[str, Any]:
        """Its arguments by name."""
        return dict(self.__dict__)

    def find(self, kind: type[R]) -> R | None:
        """This reason, or the first inside it, of a kind: decisions use kinds, never texts."""
        if isinstance(self, kind):
            return self
        inner = [one for value in self.args.values() for one in (value if isinstance(value, tuple) else (value,))]
        found = (one.find(kind) for one in inner if isinstance(one, Reason))
        return next((one for one in found if one is not None), None)

    def __repr__(self) -> str:
        return f"{self.code}({', '.join(f'{name}={value!r}' for name, value in self.args.items())})"


REGISTRY: dict[str, type[Reason]] = {}  # by code


# fmt: off
class Foreign(Reason, text="{words}"): words: str  # text of another system, or of a library
class Unknown(Reason, text="{name}", details="{arguments}"): name: str; arguments: str  # a code of another release
class Several(Reason, text="{reasons}"): reasons: tuple[Reason, ...]
# fmt: on
