"""System commands of the ROS-TCP protocol: frames whose destination begins with two underscores. Pure logic."""

import json
from typing import Any, TypeVar

from pydantic import BaseModel, ConfigDict, Field, ValidationError, field_validator

from tms_if.framing import encode
from tms_reason.texts import text
from tms_reason.validation import explain

VERSION = "v0.7.0"  # version of the protocol, not of this project; the simulator wants v0.7
NAME = r"^/?[A-Za-z_][A-Za-z0-9_]*(/[A-Za-z_][A-Za-z0-9_]*)*$"
LONGEST = 246  # letters of a name; rmw allows 247 with the leading slash
DEEPEST_QUEUE = 1000  # messages; a client may ask for more


class CommandError(Exception):
    """A command cannot be carried out; the text goes back to the client."""


class Registration(BaseModel):
    """A topic or service that a client wants to publish, receive, call or serve."""

    model_config = ConfigDict(frozen=True)

    topic: str = Field(pattern=NAME, max_length=LONGEST)
    message_name: str = Field(pattern=r"^\w+/(\w+/)?\w+$", max_length=255)
    queue_size: int = 10
    latch: bool = False

    @field_validator("queue_size")
    @classmethod
    def _bounded(cls, size: int) -> int:
        return min(max(size, 1), DEEPEST_QUEUE)


class Removal(BaseModel):
    """A registration that ends."""

    topic: str = Field(pattern=NAME, max_length=255)


class ServiceId(BaseModel):
    """The next frame is a service request or response with this number."""

    srv_id: int = Field(ge=-(2**31), lt=2**31)


T = TypeVar("T", bound=BaseModel)


def parse(kind: type[T], command: str, payload: bytes) -> T:
    """Parse a command's JSON, which the simulator ends with a NUL.

    Raises:
        CommandError: it is no JSON, or does not have the fields of the command.
    """
    try:
        return kind.model_validate_json(payload.rstrip(b"\0"))
    except ValidationError as error:
        raise CommandError(f"{command}: {text(explain(error), 'en')}") from error


def command(name: str, **fields: Any) -> bytes:
    """A command as a frame."""
    return encode(name, json.dumps(fields).encode())


def handshake() -> bytes:
    """The first frame that the simulator expects; its metadata are JSON in a string of JSON."""
    return command("__handshake", version=VERSION, metadata=json.dumps({"protocol": "ROS2"}))


def full_name(topic: str) -> str:
    """The full name of a topic: the simulator's names have no leading slash and belong to the root namespace."""
    return f"/{topic.removeprefix('/')}"
