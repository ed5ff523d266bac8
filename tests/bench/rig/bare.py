"""Plain rclpy processes, the floor of the figures: nothing of ours but the interface types.

python bare.py node                      a node that does nothing
python bare.py hear JOINTS ODOM          a node that hears the joint states and the odometry of one machine
python bare.py serve                     an action /bare/act that succeeds at once and a service /bare/get
python bare.py same FILE                 a node with the ends (names and types by kind, as JSON) of another one
python bare.py act COUNT                 one goal after another; prints their milliseconds as JSON
python bare.py link NAME [NEXT]          an action server that reads /bare/get if it is the first, accepts, and passes
                                         each goal on to NEXT; without NEXT the goal succeeds at once
python bare.py chain COUNT FIRST LAST    one goal after another to FIRST, until LAST is seen to have accepted it
python bare.py get SERVICE MODEL RECORD COUNT   one GetParameter after another; the same
"""

from __future__ import annotations

import ctypes
import importlib
import json
import os
import signal
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import rclpy
from action_msgs.msg import GoalStatusArray
from nav_msgs.msg import Odometry
from rclpy.action import ActionClient, ActionServer, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node
from rclpy.qos import QoSProfile, qos_profile_action_status_default, qos_profile_sensor_data
from sensor_msgs.msg import JointState
from tms_msg_db.msg import Record
from tms_msg_db.srv import GetParameter
from tms_msg_ts.action import LeafNodeBase

DEPTH = QoSProfile(depth=100)
LIMIT = 60.0  # s for a floor to be measured
BEGUN = time.perf_counter()  # everything is imported; the node is made now
PARTS = {"SendGoal": "SendGoalService", "GetResult": "GetResultService", "FeedbackMessage": "FeedbackMessage"}
WARM = 10  # rounds that do not count


def receive(node: Node, joints: str, odom: str) -> None:
    node.create_subscription(JointState, joints, lambda _: None, qos_profile_sensor_data)
    node.create_subscription(Odometry, odom, lambda _: None, qos_profile_sensor_data)
    rclpy.spin(node)


def same(node: Node, file: str) -> None:
    making: dict[str, Callable[[Any, str], object]] = {
        "publisher": lambda kind, name: node.create_publisher(kind, name, qos_profile_action_status_default),
        "subscription": lambda kind, name: node.create_subscription(kind, name, lambda _: None, 1),
        "service": lambda kind, name: node.create_service(kind, name, lambda _, response: response),
        "client": node.create_client,
    }
    ends = json.loads(Path(file).read_text(encoding="utf-8"))
    node.kept = [making[kind](_type(one), name) for kind, found in ends.items() for name, one in found]
    rclpy.spin(node)


def _type(name: str) -> Any:
    """The class of `std_msgs/msg/Bool`, or of a hidden part of an action."""
    package, kind, last = name.split("/")
    module = importlib.import_module(f"{package}.{kind}")
    if kind != "action":
        return getattr(module, last)
    action, _, part = last.rpartition("_")
    return getattr(getattr(module, action).Impl, PARTS[part])


def serve(node: Node) -> None:
    def act(handle: Any) -> LeafNodeBase.Result:
        handle.succeed()
        return LeafNodeBase.Result(result=True)

    def get(_: Any, response: GetParameter.Response) -> GetParameter.Response:
        response.record = Record(model_name="m", record_name="r", type="static")
        return response

    node.kept = [
        ActionServer(node, LeafNodeBase, "/bare/act", act, result_timeout=5),
    ]
    node.create_service(GetParameter, "/bare/get", get, qos_profile=DEPTH)
    rclpy.spin(node)


def link(node: Node, name: str, following: str = "") -> None:
    group = ReentrantCallbackGroup()
    first = name.endswith("0")
    records = node.create_client(GetParameter, "/bare/get", qos_profile=DEPTH, callback_group=group)
    after = ActionClient(node, LeafNodeBase, following, callback_group=group) if following else None

    async def decide(_: Any) -> GoalResponse:
        if first:
            await records.call_async(GetParameter.Request())
        return GoalResponse.ACCEPT

    def accepted(handle: Any) -> None:
        if after is None:
            handle.execute(succeed)
            return
        after.send_goal_async(LeafNodeBase.Goal()).add_done_callback(
            lambda sent: sent.result().get_result_async().add_done_callback(lambda _: handle.execute(succeed))
        )

    def succeed(handle: Any) -> LeafNodeBase.Result:
        handle.succeed()
        return LeafNodeBase.Result(result=True)

    node.kept = ActionServer(
        node, LeafNodeBase, name, succeed, goal_callback=decide, handle_accepted_callback=accepted, result_timeout=5,
        callback_group=group,
    )  # fmt: skip
    assert records.wait_for_service(LIMIT)
    assert after is None or after.wait_for_server(LIMIT)
    rclpy.spin(node)


def chain(node: Node, count: str, first: str, last: str) -> list[float]:
    """The next goal leaves when the last one has come back."""
    client, rounds, known = ActionClient(node, LeafNodeBase, first), Rounds(int(count)), set[bytes]()

    def send() -> None:
        rounds.begin()
        client.send_goal_async(LeafNodeBase.Goal()).add_done_callback(
            lambda sent: sent.result().get_result_async().add_done_callback(lambda _: again())
        )

    def again() -> None:
        if rounds.left:
            send()

    def seen(message: GoalStatusArray) -> None:
        goals = {bytes(one.goal_info.goal_id.uuid) for one in message.status_list}
        if goals - known:
            rounds.end()
        known.update(goals)

    node.create_subscription(GoalStatusArray, f"{last}/_action/status", seen, qos_profile_action_status_default)
    return _run(node, client.server_is_ready, send, rounds)


class Rounds:
    """Times rounds that end in a callback, each started by the end of the last one."""

    def __init__(self, count: int) -> None:
        self.left, self.times = count + WARM, []  # type: ignore[var-annotated]

    def begin(self) -> None:
        self._begun = time.perf_counter()

    def end(self) -> bool:
        self.times.append((time.perf_counter() - self._begun) * 1000)
        self.left -= 1
        return self.left > 0


def act(node: Node, count: str) -> list[float]:
    client, rounds = ActionClient(node, LeafNodeBase, "/bare/act"), Rounds(int(count))

    def send() -> None:
        rounds.begin()
        client.send_goal_async(LeafNodeBase.Goal()).add_done_callback(accepted)

    def accepted(future: Any) -> None:
        future.result().get_result_async().add_done_callback(lambda _: send() if rounds.end() else None)

    return _run(node, client.server_is_ready, send, rounds)


def get(node: Node, service: str, model: str, record: str, count: str) -> list[float]:
    client, rounds = node.create_client(GetParameter, service, qos_profile=DEPTH), Rounds(int(count))
    wanted = GetParameter.Request(model_name=model, record_name=record)

    def send() -> None:
        rounds.begin()
        client.call_async(wanted).add_done_callback(answered)

    def answered(future: Any) -> None:
        assert not future.result().error_code, future.result().error_msg
        if rounds.end():
            send()

    return _run(node, client.service_is_ready, send, rounds)


def find(node: Node, count: str) -> list[float]:
    while len(node.get_node_names()) <= int(count):
        rclpy.spin_once(node, timeout_sec=0.005)
        assert time.perf_counter() - BEGUN < LIMIT, f"only {len(node.get_node_names()) - 1} of {count} found"
    return [(time.perf_counter() - BEGUN) * 1000]


def fleet(count: str, kind: str = "") -> None:
    """Forks, so that imports are paid once; each child leaves when its parent does. `acting` ones serve an action."""
    os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "SYSTEM_DEFAULT"  # TELLS_FEW; a bare node imports nothing of ours
    left, right = os.pipe()
    for number in range(int(count)):
        if os.fork() == 0:
            ctypes.CDLL(None).prctl(1, signal.SIGKILL)  # PR_SET_PDEATHSIG
            rclpy.init()
            node = _node(f"fleet_{number}")
            if kind == "acting":
                node.kept = ActionServer(node, LeafNodeBase, f"/fleet_{number}/act", lambda _: None)
            os.write(right, b".")
            rclpy.spin(node)
            return
    for _ in range(int(count)):
        os.read(left, 1)
    print("ready", flush=True)
    signal.pause()


def _node(name: str) -> Node:
    return rclpy.create_node(name, start_parameter_services=False, enable_rosout=False)


def _run(node: Node, ready: Any, first: Any, rounds: Rounds) -> list[float]:
    deadline = time.monotonic() + LIMIT
    while not ready():
        rclpy.spin_once(node, timeout_sec=0.05)
        assert time.monotonic() < deadline, "the other side is not there"
    first()
    while rounds.left and time.monotonic() < deadline:
        rclpy.spin_once(node, timeout_sec=1.0)
    assert not rounds.left, "an answer got lost"
    return rounds.times[WARM:]


STAY = {"node": rclpy.spin, "hear": receive, "same": same, "serve": serve, "link": link}


def main(what: str, *words: str) -> None:
    if what == "fleet":
        return fleet(*words)
    rclpy.init()
    node = _node(f"bare_{what}")
    if what in STAY:
        print("ready", flush=True)
        STAY[what](node, *words)
    else:
        print(json.dumps({"act": act, "chain": chain, "get": get, "find": find}[what](node, *words)), flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
