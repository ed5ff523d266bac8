"""What a client asks for ends at its own connection, whatever rclpy says to it."""

import asyncio
from collections.abc import Awaitable, Callable
from typing import Any

import pytest
from std_srvs.srv import Trigger

from tms_core.errors import RosError
from tms_core.ros import pack
from tms_if import joint_cmd
from tms_if.commands import CommandError, Registration
from tms_if.ends import OPEN_CALLS, Ends


class Ros:
    """Refuses to make any client, or answers."""

    def __init__(self) -> None:
        self.trouble: Exception | None = None

    async def ask(self, *_: Any) -> Any:
        if self.trouble is not None:
            raise self.trouble
        return Trigger.Response(success=True)

    def start(self, step: Callable[[], Awaitable[None]]) -> None:
        async def run() -> None:
            await step()

        asyncio.run(run())


def test_a_call_that_rclpy_refuses_is_told_and_counts_no_longer() -> None:
    ros, sent, said = Ros(), [], []  # type: ignore[var-annotated]
    ends = Ends(ros, joint_cmd.OURS, frozenset(), lambda frame, _: sent.append(frame), said.append)  # type: ignore[arg-type]
    ends.ros_service(Registration(topic="spawn", message_name="std_srvs/Trigger"))
    ros.trouble = RosError("service /spawn: it must not be that long", "BAD_NAME")
    for _ in range(OPEN_CALLS + 1):
        ends.request("spawn", pack(Trigger.Request()), 101)
    assert set(said) == {"service /spawn: it must not be that long"}
    assert sent == []
    ros.trouble = None
    ends.request("spawn", pack(Trigger.Request()), 102)
    assert len(sent) == 1
    with pytest.raises(CommandError, match="Not registered"):
        ends.request("other", b"", 103)
