"""Generated ROS classes as mypy sees them; it knows their fields from stubs (`make interfaces`).

Services and actions are classes that hold others: a method here stands for the class of that name, which is called
to make a message.
"""

from typing import Any, Protocol, TypeVar


class Message(Protocol):
    """Any message; also the parts of services and actions."""

    @classmethod
    def get_fields_and_field_types(cls) -> dict[str, str]: ...


class Coded(Message, Protocol):
    """An answer with an error code; an empty code is success."""

    error_code: str
    error_msg: str


M = TypeVar("M", bound=Message)
M_in = TypeVar("M_in", bound=Message, contravariant=True)
Req = TypeVar("Req", bound=Message)
Res = TypeVar("Res", bound=Message)
Reply = TypeVar("Reply", bound=Coded)
G = TypeVar("G", bound=Message)
R = TypeVar("R", bound=Message)
F = TypeVar("F", bound=Message)


class Publisher(Protocol[M_in]):
    """Sends the messages of a topic."""

    def publish(self, message: M_in | bytes, /) -> None: ...  # bytes are a serialised message
    def assert_liveliness(self) -> None: ...
    def get_subscription_count(self) -> int: ...
    def wait_for_all_acked(self, timeout: Any) -> bool: ...


class ServiceType(Protocol[Req, Res]):
    """A service: its request and its response."""

    def Request(self) -> Req: ...
    def Response(self) -> Res: ...
    def _types(self, request: Req, response: Res, /) -> None: ...


class ActionType(Protocol[G, R, F]):
    """An action: its goal, its result and its feedback."""

    def Goal(self) -> G: ...
    def Result(self) -> R: ...
    def Feedback(self) -> F: ...
    def _types(self, goal: G, result: R, feedback: F, /) -> None: ...
