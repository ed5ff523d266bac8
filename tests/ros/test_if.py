"""The bridge as a real process, between real ROS nodes and a client that behaves as Unity does, byte for byte."""

import json
import os
import re
import socket
import struct
from array import array
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from com3_msgs.msg import JointCmd
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, Float64, Float64MultiArray
from std_srvs.srv import SetBool, Trigger

import programs
from conftest import wait_until
from tms_config.config import load_site
from tms_machine.border import PRESS_LIVES, Controls
from tms_reason.errors import RosError
from tms_ros.node import Ros
from tms_ros.packing import pack, unpack
from tms_runtime import environment
from unity_client import Unity, frame, text

pytestmark = [
    pytest.mark.ros,
    pytest.mark.filterwarnings("ignore:module 'sre_:DeprecationWarning"),  # a parser that the ROS wheels bring
]
LIMIT = 40.0  # s for whatever must happen at all
MACHINE = "zx200_5"  # a name of its own: other tests may have machines in the same domain
EMG_STOP = f"/{MACHINE}/emg_stop"
SITE = """
name: iftest
domain: {domain}
backend: physx
ports: {{metrics: {port}}}
services:
  if:
    port: {tcp}
    message_limit: 1000000
    clock: true
    calls: {{/{machine}/switch: std_srvs/SetBool}}
    offers: {{/{machine}/spawn: std_srvs/Trigger, /{machine}/odd: gazebo_msgs/Nothing}}
machines: {{{machine}: {{model: zx200}}}}
"""


class Bridge:
    """The process and a ROS node of somebody else."""

    def __init__(self, file: Path, port: int) -> None:
        self.port, self.file, self._log = port, file, file.with_suffix(".log")
        env = {**os.environ, **environment.environment(load_site(str(file)))}
        self.process = programs.process("tms:if", env, self._log)
        self.ros = Ros("if_test")
        self.clients: list[Unity] = []
        wait_until(lambda: "event=listening" in self.log, LIMIT, "the bridge listens")

    @property
    def log(self) -> str:
        return self._log.read_text()

    def unity(self, beats: bool = True) -> Unity:
        client = Unity(self.port, beats)
        self.clients.append(client)
        client.until(lambda: client.frames, "handshake")
        return client

    def logged(self, words: str, count: int = 1) -> None:
        wait_until(lambda: len(re.findall(words, self.log)) >= count, LIMIT, f"a log line {words}")

    def until(self, there: Callable[[], Any], what: str) -> None:
        wait_until(lambda: bool(there()), LIMIT, what)

    def received(self, kind: Any, topic: str) -> list[Any]:
        found: list[Any] = []
        self.ros.subscribe(kind, topic, found.append, depth=10)
        return found

    def speak(self, kind: Any, topic: str, **settings: Any) -> Any:
        publisher = self.ros.publisher(kind, topic, **settings)
        self.until(lambda: publisher.get_subscription_count() > 0, f"the bridge hears {topic}")
        return publisher

    def close(self) -> None:
        for client in self.clients:
            client.close()
        self.process.terminate()
        try:
            assert self.process.wait(10) == 0, self.log
        finally:
            self.process.kill()
            self.ros.close()


@pytest.fixture(scope="module")
def bridge(tmp_path_factory: pytest.TempPathFactory, domain: int, first_port: int) -> Iterator[Bridge]:
    folder = tmp_path_factory.mktemp("bridge")
    file = folder / "site.yaml"
    file.write_text(SITE.format(domain=domain, port=first_port + 60, tcp=first_port + 62, machine=MACHINE))
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ROS_DOMAIN_ID", str(domain))
        patch.setenv("TMS_STATE", str(folder / "state"))
        for key, value in environment.environment(load_site(str(file))).items():
            patch.setenv(key, value)
        made = Bridge(file, first_port + 62)
        yield made
        made.close()


@pytest.fixture
def unity(bridge: Bridge) -> Iterator[Unity]:
    client = bridge.unity()
    yield client
    client.close()


def test_the_handshake_comes_first(unity: Unity) -> None:
    name, payload = unity.frames[0]
    reported = json.loads(payload)
    assert name == "__handshake"
    assert reported["version"].startswith("v0.7")
    assert json.loads(reported["metadata"]) == {"protocol": "ROS2"}


def test_what_unity_publishes_arrives(bridge: Bridge, unity: Unity) -> None:
    received = bridge.received(JointState, f"/{MACHINE}/joint_state")
    topic = f"{MACHINE}/joint_state"
    unity.command("__publish", topic=topic, message_name="sensor_msgs/JointState", queue_size=10, latch=False)
    state = JointState(name=["swing_joint", "boom_joint"], position=[0.5, -0.25], effort=[0.0, 0.0])
    state.header.frame_id = "world"

    def reported() -> bool:
        unity.message(topic, pack(state))
        return bool(received)

    bridge.until(reported, "a joint state")
    assert received[0] == state


def test_the_clock_is_a_bare_time(bridge: Bridge, unity: Unity) -> None:
    received = bridge.received(Clock, "/clock")
    unity.command("__publish", topic="clock", message_name="rosgraph_msgs/Clock", queue_size=10, latch=False)

    def reported() -> bool:
        unity.message("clock", b"\0\1\0\0" + struct.pack("<iI", 7, 500))
        return bool(received)

    bridge.until(reported, "a time")
    assert (received[0].clock.sec, received[0].clock.nanosec) == (7, 500)


def test_what_unity_hears_is_the_frame_of_the_protocol(bridge: Bridge, unity: Unity) -> None:
    topic = f"{MACHINE}/tracks/cmd_vel"
    unity.command("__subscribe", topic=topic, message_name="geometry_msgs/Twist")
    publisher = bridge.speak(Twist, f"/{topic}")
    twist = Twist()
    twist.linear.x = 0.5
    publisher.publish(twist)
    unity.until(lambda: unity.got(topic), "a Twist")
    assert unity.got(topic)[0] == b"\0\1\0\0" + struct.pack("<6d", 0.5, 0, 0, 0, 0, 0)


@pytest.fixture
def stop(bridge: Bridge) -> Iterator[Callable[[], None]]:
    """Press a machine's stop as a gateway that has just begun: it says it once, before it has discovered anybody."""
    gateways: list[Ros] = []

    def press() -> None:
        gateways.append(Ros("if_gateway"))
        gateways[0].publisher(Bool, EMG_STOP, latched=True).publish(Bool(data=True))

    yield press
    gateways[0].close()
    bridge.until(lambda: bridge.ros.node.count_publishers(EMG_STOP) == 0, "no gateway any more")


def hear_stops(simulator: Unity) -> None:
    simulator.command("__subscribe", topic=EMG_STOP[1:], message_name="std_msgs/Bool")


def stops(simulator: Unity) -> list[bytes]:
    return simulator.got(EMG_STOP[1:])


def test_a_simulator_that_comes_late_is_told_that_it_is_stopped(bridge: Bridge, stop: Callable[[], None]) -> None:
    stop()
    late = bridge.unity()
    hear_stops(late)
    late.until(lambda: stops(late), "the latched stop")
    assert stops(late)[0] in (b"\0\1\0\0\1", b"\0\1\0\0\1\0\0\0")  # DDS pads to four bytes
    late.close()


def test_a_simulator_that_comes_late_is_told_so_where_a_host_agent_may_press_too(
    bridge: Bridge, unity: Unity, stop: Callable[[], None]
) -> None:
    host = Ros("if_host")
    controls = Controls(host, MACHINE, load_site(str(bridge.file)).border(MACHINE), keeps_emergency=False)
    (info,) = host.node.get_publishers_info_by_topic(EMG_STOP)
    assert info.qos_profile.lifespan.nanoseconds == PRESS_LIVES * 1e9, "what it presses is not kept for long"
    hear_stops(unity)
    bridge.until(lambda: host.node.count_subscribers(EMG_STOP) > 0, "the host agent knows the bridge")
    controls.emergency(False)
    unity.until(lambda: stops(unity), "what the host agent says")
    stop()
    # The bridge subscribes anew for the gateway, and may then hear once more, and later, what the host agent said.
    unity.until(lambda: any(one[4] == 1 for one in stops(unity)), "what the gateway says")
    late = bridge.unity()
    hear_stops(late)
    late.until(lambda: stops(late), "the latched stop")
    controls.emergency(False)
    late.until(lambda: stops(late)[-1][4] == 0, "what the host agent says is heard as well")
    late.close()
    host.close()


def test_a_simulator_that_comes_early_is_told_that_it_is_stopped(
    bridge: Bridge, unity: Unity, stop: Callable[[], None]
) -> None:
    hear_stops(unity)
    bridge.until(lambda: bridge.ros.node.count_subscribers(EMG_STOP) > 0, "the bridge hears")
    stop()
    unity.until(lambda: stops(unity), "the latched stop")


def test_joint_commands_in_the_layout_of_the_simulator(bridge: Bridge, unity: Unity) -> None:
    topic = f"{MACHINE}/front_cmd"
    unity.command("__subscribe", topic=topic, message_name="com3_msgs/JointCmd")
    publisher = bridge.speak(JointCmd, f"/{topic}")
    publisher.publish(JointCmd(joint_name=["boom_joint", "swing_joint"], control_type=1, position=[-0.5, 1.0]))
    unity.until(lambda: unity.got(topic), "a JointCmd")
    names = struct.pack("<II", 2, 11) + b"boom_joint\0" + b"\0" + struct.pack("<I", 12) + b"swing_joint\0"
    plain = b"\0\1\0\0" + names + struct.pack("<I2d", 2, -0.5, 1.0) + bytes(8)
    assert unity.got(topic)[0] == plain  # without control_type


def test_unity_calls_a_service(bridge: Bridge, unity: Unity) -> None:
    def switch(request: Any, response: Any) -> Any:
        response.success, response.message = request.data, "switched"
        return response

    bridge.ros.offer(SetBool, f"/{MACHINE}/switch", switch)
    unity.command("__ros_service", topic=f"{MACHINE}/switch", message_name="std_srvs/SetBool")
    unity.command("__request", srv_id=101)
    unity.message(f"{MACHINE}/switch", pack(SetBool.Request(data=True)))
    unity.until(lambda: unity.got("__response"), "a response")
    assert json.loads(unity.got("__response")[0]) == {"srv_id": 101}
    names = [name for name, _ in unity.frames]
    assert names[names.index("__response") + 1] == f"{MACHINE}/switch"
    answer = unpack(unity.got(f"{MACHINE}/switch")[0], SetBool.Response)
    assert answer.success and answer.message == "switched"


def test_unity_offers_a_service_and_may_leave_without_an_answer(bridge: Bridge) -> None:
    unity = bridge.unity()
    service = f"{MACHINE}/spawn"
    unity.command("__unity_service", topic=service, message_name="std_srvs/Trigger")
    import threading

    answers: list[Any] = []

    def call() -> None:
        try:
            answers.append(bridge.ros.call(Trigger, f"/{service}", Trigger.Request(), 20.0))
        except RosError as error:
            answers.append(error)

    threading.Thread(target=call).start()
    unity.until(lambda: unity.got(service), "a request")
    (number,) = [json.loads(payload)["srv_id"] for payload in unity.got("__request")]
    assert number >= 1001
    assert unity.got(service)[0][:4] == b"\0\1\0\0"
    unity.command("__response", srv_id=number)
    unity.message(service, pack(Trigger.Response(success=True, message="there")))
    bridge.until(lambda: answers, "the answer")
    assert answers[0].message == "there"

    before = len(unity.got(service))
    asked = threading.Thread(target=lambda: _expect_no_answer(bridge, service))
    asked.start()
    unity.until(lambda: len(unity.got(service)) > before, "a second request")
    unity.close()
    asked.join(LIMIT)
    assert not asked.is_alive()
    bridge.unity().close()  # it still serves


def _expect_no_answer(bridge: Bridge, service: str) -> None:
    with pytest.raises(RosError):
        bridge.ros.call(Trigger, f"/{service}", Trigger.Request(), 3.0)


def test_what_cannot_be_done_is_said_once_and_the_rest_goes_on(bridge: Bridge, unity: Unity) -> None:
    odom, pose = f"{MACHINE}/odom", f"{MACHINE}/base_link/pose"
    unity.command("__unity_service", topic=f"{MACHINE}/odd", message_name="gazebo_msgs/Nothing")
    unity.command("__subscribe", topic="a b", message_name="std_msgs/Bool")
    unity.command("__subscribe", topic="tms/runs", message_name="std_msgs/Bool")
    unity.command("__publish", topic=f"{MACHINE}/tracks/cmd_vel", message_name="geometry_msgs/Twist", queue_size=1)
    unity.command("__publish", topic=pose, message_name="nav_msgs/Odometry", queue_size=1)
    unity.command("__ros_service", topic=f"{MACHINE}/rearm", message_name="std_srvs/Trigger")
    unity.command("__dance")
    unity.raw(frame(text("__subscribe"), b"{broken\0"))
    for _ in range(3):
        unity.message("nobody/registered", b"\0\1\0\0\1")
        unity.message(f"{MACHINE}/tracks/cmd_vel", b"\0\1\0\0\1")
    unity.command("__publish", topic=odom, message_name="nav_msgs/Odometry", queue_size=1)
    unity.message(odom, b"\0")
    unity.command("__response", srv_id=5)
    unity.message(odom, b"\0\1\0\0\1")
    parts = (
        "no gazebo_msgs/Nothing here", "__subscribe: topic: ", "a client may not listen there", "is no sensor topic",
        "is geometry_msgs/PoseStamped on this site", "is not among services.if.calls", "there is no command __dance",
        "__subscribe: Invalid JSON", "Not registered to publish topic 'nobody/registered'",
        "odom: what came is no Odometry", "request 5, which is not awaited",
    )  # fmt: skip
    unity.until(lambda: len(unity.errors()) >= len(parts), "all errors")
    said = "\n".join(unity.errors())
    for part in parts:
        assert said.count(part) == 1, f"{part} in\n{said}"
    assert len(unity.errors()) == len(parts)  # the messages of a refused topic go without a word
    unity.command("__remove_publisher", topic=odom)
    unity.command("__remove_subscriber", topic="never/there")
    unity.command("__publish", topic=f"{MACHINE}/joint_state", message_name="sensor_msgs/JointState", queue_size=1)
    unity.command("__topic_list")
    unity.until(lambda: unity.got("__topic_list"), "the topics")
    reported = json.loads(unity.got("__topic_list")[0])
    types = dict(zip(reported["topics"], reported["types"], strict=True))
    assert types[f"/{MACHINE}/joint_state"] == "sensor_msgs/JointState"


def test_one_client_a_topic(bridge: Bridge) -> None:
    topic = f"{MACHINE}/odom"
    odometry = {"topic": topic, "message_name": "nav_msgs/Odometry", "queue_size": 10, "latch": False}
    received = bridge.received(Odometry, f"/{topic}")
    first, second = bridge.unity(), bridge.unity()
    first.command("__publish", **odometry)
    first.command("__publish", **odometry)  # as the simulator does on its first connect
    bridge.until(lambda: bridge.ros.node.count_publishers(f"/{topic}") == 1, "one publisher")
    second.command("__publish", **odometry)
    second.until(second.errors, "a refusal")
    host, port = first.socket.getsockname()
    assert second.errors() == [f"/{topic} is published by {host}:{port}: the messages of a second client are left out"]

    def reported(client: Unity, frame_id: str) -> bool:
        message = Odometry()
        message.header.frame_id = frame_id
        client.message(topic, pack(message))
        return any(one.header.frame_id == frame_id for one in received)

    second.message(topic, pack(Odometry()))
    bridge.until(lambda: reported(first, "first"), "what the first tells")
    first.close()
    bridge.until(lambda: reported(second, "second"), "what the second tells, once the first has left")
    assert {one.header.frame_id for one in received} == {"first", "second"}
    assert first.errors() == []
    second.close()


@pytest.mark.parametrize(
    ("data", "line"),
    [
        (b"GET / HTTP/1.1\r\n\r\n", "is that a ROS-TCP client?"),
        (struct.pack("<I", 5) + b"clock" + struct.pack("<I", 2**31), "a message of 2147483648 bytes"),
        (frame(text("clock"), bytes(12))[:15], "it left in the middle of a message, after 15 bytes"),
        (frame(b"\xff\xfe", b""), "a destination that is no text"),
    ],
)
def test_a_broken_client_ends_alone(bridge: Bridge, data: bytes, line: str) -> None:
    broken = bridge.unity(beats=False)
    host, port = broken.socket.getsockname()
    broken.raw(data)
    if "left" in line:
        broken.socket.shutdown(socket.SHUT_WR)
    broken.until(broken.closed.is_set, "end of the connection")
    bridge.logged(f"event=client_gone client={host}:{port} .*{re.escape(line)}")
    assert bridge.process.returncode is None
    assert "Traceback" not in bridge.log
    bridge.unity().close()


def test_a_client_that_does_not_read_loses_messages_and_nothing_else(bridge: Bridge) -> None:
    lazy, good = Unity(bridge.port, reads=False), bridge.unity()
    bridge.clients.append(lazy)
    topic = f"{MACHINE}/unity/drive_params"
    for client in (lazy, good):
        client.command("__subscribe", topic=topic, message_name="std_msgs/Float64MultiArray")
    publisher = bridge.ros.publisher(Float64MultiArray, f"/{topic}")
    bridge.until(lambda: publisher.get_subscription_count() == 2, "both hear")
    host, port = lazy.socket.getsockname()
    message = Float64MultiArray(data=array("d", bytes(500_000)))

    def slow() -> bool:
        publisher.publish(message)
        return f"event=client_slow client={host}:{port}" in bridge.log

    bridge.until(slow, "a line about the slow client")
    good.until(lambda: good.got(topic), "messages at the other client")
    bridge.logged(f"event=client_gone client={host}:{port} .*did not read for 10 s")
    lazy.close()
    good.close()
    status = Path(f"/proc/{bridge.process.pid}/status").read_text()
    (kilobytes,) = re.findall(r"VmHWM:\s+(\d+) kB", status)
    assert int(kilobytes) < 400_000


def test_it_listens_on_loopback_and_says_when_it_cannot(bridge: Bridge, tmp_path: Path, domain: int) -> None:
    (tmp_path / "site.yaml").write_text(
        SITE.format(domain=domain, port=bridge.port + 1, tcp=bridge.port, machine=MACHINE)
    )
    env = {**os.environ, **environment.environment(load_site(str(tmp_path / "site.yaml")))}
    second = programs.process("tms:if", env, tmp_path / "log.txt")
    said = second.output(60)
    assert second.returncode == 1
    assert f"127.0.0.1:{bridge.port} cannot be listened on" in said
    assert "services.if" in said
    held = Path("/proc/net/tcp").read_text()
    assert f"0100007F:{bridge.port:04X} 00000000:0000 0A" in held  # and on no other address
    assert f"00000000:{bridge.port:04X}" not in held


def test_a_best_effort_publisher_is_heard(bridge: Bridge, unity: Unity) -> None:
    from rclpy.qos import QoSProfile, ReliabilityPolicy

    qos = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
    topic = f"{MACHINE}/swing/cmd"
    unity.command("__subscribe", topic=topic, message_name="std_msgs/Float64")
    wait_until(lambda: bridge.ros.node.count_subscribers(f"/{topic}") > 0, LIMIT, "the bridge hears")
    publisher = bridge.ros.node.create_publisher(Float64, f"/{topic}", qos)

    def heard() -> bool:
        publisher.publish(Float64(data=0.5))
        return bool(unity.got(topic))

    bridge.until(heard, "what is published later, and at best effort")
    assert unpack(unity.got(topic)[0], Float64).data == 0.5
