"""A client and a server as upstream's nodes are: rclpy and upstream's message definitions, no code of this project.

usage: upstream_client.py leaf MACHINE SUBTASK RECORD [FIELD=TEXT...]
                                                           one LeafNodeBase goal; prints `<status> <result>`, and the
                                                           last feedback where there was one
       upstream_client.py rp NAMESPACE ACTION X Y Z THETA  one TmsRpZx200ChangePose goal; prints `<status> <error code>`
       upstream_client.py template NAME                    asks tms_db_reader_subtask; prints the text
       upstream_client.py serve MACHINE SUBTASK            serves LeafNodeBase until it is ended; prints each goal

It speaks the form of LeafNodeBase that stands first on its paths.
"""

import sys
import time

import rclpy
from rclpy.action import ActionClient, ActionServer
from tms_msg_db.srv import TmsdbGetTask
from tms_msg_rp.action import TmsRpZx200ChangePose
from tms_msg_rp.msg import TmsRpZx200PositionWithAngle
from tms_msg_ts.action import LeafNodeBase

LIMIT = 60.0  # s


def ask(node, kind, name, goal):
    """Send one goal the way the C++ leaf does; status and result."""
    client = ActionClient(node, kind, name)
    if not client.wait_for_server(LIMIT):
        sys.exit(f"{name} is not there")
    said = []
    sent = client.send_goal_async(goal, feedback_callback=said.append)
    rclpy.spin_until_future_complete(node, sent, timeout_sec=LIMIT)
    if sent.result() is None or not sent.result().accepted:
        return "rejected", None, ""
    ended = sent.result().get_result_async()
    rclpy.spin_until_future_complete(node, ended, timeout_sec=LIMIT)
    last = getattr(said[-1].feedback, "status", "") if said else ""
    return ended.result().status, ended.result().result, last


def leaf(node, machine, subtask, record, *further):
    fields = dict(word.split("=") for word in further)
    goal = LeafNodeBase.Goal(model_name=machine, record_name=record, **fields)
    status, result, said = ask(node, LeafNodeBase, f"/{machine}/{subtask}", goal)
    print(status, getattr(result, "result", None), said)


def rp(node, namespace, action, x, y, z, theta_w):
    target = TmsRpZx200PositionWithAngle(theta_w=float(theta_w))
    target.position.x, target.position.y, target.position.z = float(x), float(y), float(z)
    goal = TmsRpZx200ChangePose.Goal(position_with_angle_sequence=[target])
    status, result, _ = ask(node, TmsRpZx200ChangePose, f"/{namespace}/{action}", goal)
    print(status, result.error_code.val if result else None)


def template(node, name):
    client = node.create_client(TmsdbGetTask, "tms_db_reader_subtask")
    if not client.wait_for_service(LIMIT):
        sys.exit("tms_db_reader_subtask is not there")
    asked = client.call_async(TmsdbGetTask.Request(task_name=name))
    rclpy.spin_until_future_complete(node, asked, timeout_sec=LIMIT)
    print(asked.result().task)


def serve(node, machine, subtask):
    def execute(handle):
        handle.publish_feedback(LeafNodeBase.Feedback(status="foreign server at work"))
        time.sleep(0.2)
        print(*(getattr(handle.request, name) for name in handle.request.get_fields_and_field_types()), flush=True)
        handle.succeed()
        return LeafNodeBase.Result(result=True)

    server = ActionServer(node, LeafNodeBase, f"/{machine}/{subtask}", execute)
    print("ready", flush=True)
    rclpy.spin(node)
    server.destroy()


if __name__ == "__main__":
    rclpy.init()
    {"leaf": leaf, "rp": rp, "template": template, "serve": serve}[sys.argv[1]](
        rclpy.create_node("upstream"), *sys.argv[2:]
    )
