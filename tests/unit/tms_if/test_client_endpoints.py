"""What a client asks for ends at its own connection, whatever rclpy says to it."""

import asyncio
from collections.abc import Awaitable, Callable
from types import SimpleNamespace
from typing import Any

import pytest
from nav_msgs.msg import Odometry
from std_srvs.srv import Trigger

from tms_if import joint_cmd
from tms_if.client_endpoints import OPEN_CALLS, ClientEndpoints
from tms_if.commands import CommandError, Registration
from tms_if.names import Allowed
from tms_reason.errors import RosError
from tms_reason.reason import Foreign
from tms_ros.packing import pack

TOPIC, SPAWN = "zx200/odom", "/spawn"
ALLOWED = Allowed(
    published={"/zx200/odom": frozenset({"nav_msgs/Odometry"})},
    received={},
    called={SPAWN: frozenset({"std_srvs/Trigger"})},
    offered={},
)
ODOM = Registration(topic=TOPIC, message_name="nav_msgs/Odometry")


class Publisher:
    def __init__(self) -> None:
        self.sent: list[bytes] = []

    def publish(self, payload: bytes) -> None:
        self.sent.append(payload)


class Ros:
    """Refuses to make any client, or answers."""

    def __init__(self) -> None:
        self.trouble: Exception | None = None
        self.publishers: list[Publisher] = []
        self.node = SimpleNamespace(
            destroy_publisher=lambda gone: self.publishers.remove(gone), destroy_timer=lambda gone: None
        )

    def every(self, _seconds: float, _step: Callable[[], None]) -> None:
        """No time passes here."""

    async def call_async(self, *_: Any) -> Any:
        if self.trouble is not None:
            raise self.trouble
        return Trigger.Response(success=True)

    def start(self, step: Callable[[], Awaitable[None]]) -> None:
        async def run() -> None:
            await step()

        asyncio.run(run())

    def do(self, step: Callable[[], Any], _seconds: float) -> Any:
        return step()

    def on_executor(self, step: Callable[[], Any]) -> None:
        step()

    def publisher(self, *_: Any) -> Publisher:
        if self.trouble is not None:
            raise self.trouble
        self.publishers.append(Publisher())
        return self.publishers[-1]


class Client:
    """One client's ends."""

    def __init__(self, ros: Ros, speakers: dict[str, str], name: str) -> None:
        self.sent: list[bytes] = []
        self.said: list[str] = []
        send, say = (lambda frame, _: self.sent.append(frame)), self.said.append
        self.ends = ClientEndpoints(ros, joint_cmd.OURS, ALLOWED, speakers, name, send, say)  # type: ignore[arg-type]


@pytest.fixture
def ros() -> Ros:
    return Ros()


def test_a_call_that_rclpy_refuses_is_told_and_counts_no_longer(ros: Ros) -> None:
    client = Client(ros, {}, "1.2.3.4:5")
    client.ends.ros_service(Registration(topic="spawn", message_name="std_srvs/Trigger"))
    ros.trouble = RosError(Foreign("service /spawn: it must not be that long"), "BAD_NAME")
    for _ in range(OPEN_CALLS + 1):
        client.ends.request("spawn", pack(Trigger.Request()), 101)
    assert set(client.said) == {"service /spawn: it must not be that long"}
    assert client.sent == []
    ros.trouble = None
    client.ends.request("spawn", pack(Trigger.Request()), 102)
    assert len(client.sent) == 1
    with pytest.raises(CommandError, match="Not registered"):
        client.ends.request("other", b"", 103)


def test_a_refused_topic_is_told_once_and_its_messages_are_dropped(ros: Ros) -> None:
    client = Client(ros, {}, "1.2.3.4:5")
    with pytest.raises(CommandError, match="/zx200/goal_pose is no sensor topic"):
        client.ends.publish(Registration(topic="zx200/goal_pose", message_name="geometry_msgs/PoseStamped"))
    with pytest.raises(CommandError, match="/zx200/odom is nav_msgs/Odometry on this site, not nav_msgs/Path"):
        client.ends.publish(Registration(topic=TOPIC, message_name="nav_msgs/Path"))
    client.ends.message("zx200/goal_pose", b"")
    client.ends.message("/zx200/goal_pose", b"")
    with pytest.raises(CommandError, match="Not registered to publish topic 'zx200/other'"):
        client.ends.message("zx200/other", b"")
    assert ros.publishers == [] and client.said == []


def test_a_source_that_comes_back_under_another_type_is_refused_until_it_has_its_own(ros: Ros) -> None:
    client = Client(ros, {}, "1.2.3.4:5")
    client.ends.publish(ODOM)
    with pytest.raises(CommandError, match="/zx200/odom is nav_msgs/Odometry on this site, not nav_msgs/Path"):
        client.ends.publish(Registration(topic=TOPIC, message_name="nav_msgs/Path"))
    client.ends.message(TOPIC, pack(Odometry()))
    assert ros.publishers == []
    client.ends.publish(ODOM)
    client.ends.message(TOPIC, pack(Odometry()))
    assert [len(publisher.sent) for publisher in ros.publishers] == [1]


def test_a_registration_that_comes_twice_keeps_its_publisher(ros: Ros) -> None:
    client = Client(ros, {}, "1.2.3.4:5")
    for topic in (TOPIC, TOPIC, f"/{TOPIC}"):
        client.ends.publish(Registration(topic=topic, message_name="nav_msgs/msg/Odometry"))
    (publisher,) = ros.publishers
    client.ends.message(f"/{TOPIC}", pack(Odometry()))
    client.ends.message(TOPIC, pack(Odometry()))
    assert ros.publishers == [publisher] and len(publisher.sent) == 2


def test_one_client_a_topic(ros: Ros) -> None:
    speakers: dict[str, str] = {}
    first, second = Client(ros, speakers, "1.2.3.4:5"), Client(ros, speakers, "1.2.3.4:6")
    first.ends.publish(ODOM)
    with pytest.raises(CommandError, match=r"/zx200/odom is published by 1\.2\.3\.4:5: .* are left out"):
        second.ends.publish(ODOM)
    second.ends.message(TOPIC, pack(Odometry()))
    assert [publisher.sent for publisher in ros.publishers] == [[]]
    second.ends.remove_publisher(TOPIC)  # takes nothing from the first
    assert speakers == {"/zx200/odom": "1.2.3.4:5"}

    first.ends.close()
    assert speakers == {} and ros.publishers == []
    second.ends.publish(ODOM)
    assert speakers == {"/zx200/odom": "1.2.3.4:6"}


def test_who_waits_for_a_topic_gets_it_when_the_first_has_left(ros: Ros) -> None:
    """A simulator that comes back before the end of its old connection is known registers only once."""
    speakers: dict[str, str] = {}
    old, new = Client(ros, speakers, "1.2.3.4:5"), Client(ros, speakers, "1.2.3.4:6")
    old.ends.publish(ODOM)
    with pytest.raises(CommandError, match="is published by"):
        new.ends.publish(ODOM)
    old.ends.close()
    new.ends.message(TOPIC, pack(Odometry()))
    new.ends.message(TOPIC, pack(Odometry()))
    assert [len(publisher.sent) for publisher in ros.publishers] == [2]
    assert new.said == ["/zx200/odom: the other client has left: the messages of this one are taken from now on"]


def test_a_topic_that_could_not_be_made_is_free(ros: Ros) -> None:
    speakers: dict[str, str] = {}
    client = Client(ros, speakers, "1.2.3.4:5")
    ros.trouble = RosError(Foreign("the ROS thread did not answer within 5 s"), "BUSY")
    with pytest.raises(CommandError, match="did not answer"):
        client.ends.publish(ODOM)
    assert speakers == {}
