"""A client and a server as upstream's nodes are: rclpy and upstream's message definitions, no code of this project.

usage: upstream_client.py leaf MACHINE SUBTASK RECORD [FIELD=TEXT...]
                                                           one LeafNodeBase goal; prints `<status> <result>`, and the
                                                           last feedback where there was one
       upstream_client.py rp NAMESPACE ACTION X Y Z THETA  one TmsRpZx200ChangePose goal; prints `<status> <error code>`
       upstream_client.py template NAME                    asks tms_db_reader_subtask; prints the text
       upstream_client.py plan SERVICE NAME                asks for the plan of a record; prints the x of its poses
       upstream_client.py excavator MACHINE JOINT ANGLE... sets the planner, plans to joint angles, executes the plan;
                                                           prints status and error code of both, and the angles
       upstream_client.py planner MACHINE                  serves tms_rp_excavator until it is ended: plans straight to
                                                           the angles within 10 s; prints command, group and start
       upstream_client.py serve MACHINE SUBTASK            serves LeafNodeBase until it is ended; prints each goal

It speaks the forms that stand first on its paths.
"""

import sys
import time

import rclpy
from rclpy.action import ActionClient, ActionServer
from tms_msg_db.srv import TmsdbGetData, TmsdbGetTask
from tms_msg_rp.action import TmsRpExcavator, TmsRpZx200ChangePose
from tms_msg_rp.msg import TmsRpExcavatorJointValues, TmsRpZx200PositionWithAngle
from tms_msg_rp.srv import TmsRpExcavatorParamGet, TmsRpExcavatorParamSet
from tms_msg_ts.action import LeafNodeBase
from trajectory_msgs.msg import JointTrajectoryPoint

LIMIT = 60.0  # s
START = (0.0, -0.8029, 1.9897, 0.8029)  # rad, where a zx200 stands at first


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


def call(node, kind, name, request):
    client = node.create_client(kind, name)
    if not client.wait_for_service(LIMIT):
        sys.exit(f"{name} is not there")
    asked = client.call_async(request)
    rclpy.spin_until_future_complete(node, asked, timeout_sec=LIMIT)
    return asked.result()


def template(node, name):
    print(call(node, TmsdbGetTask, "tms_db_reader_subtask", TmsdbGetTask.Request(task_name=name)).task)


def plan(node, service, name):
    request = TmsdbGetData.Request(type="parameter", id=3012, param_type="plan", name=name)
    for found in call(node, TmsdbGetData, service, request).tmsdbs:
        print(node.count_services(f"/{service}"), *(one.pose.position.x for one in found.plan.poses))


def excavator(node, machine, *pairs):
    name = f"/{machine}/tms_rp_excavator"
    settings = TmsRpExcavatorParamSet.Request(
        goal_position_tolerance=0.5,
        goal_orientation_tolerance=0.5,
        goal_joint_tolerance=-1.0,
        planning_time=-1.0,
        max_velocity_scaling_factor=1.0,
        max_acceleration_scaling_factor=1.0,
        num_planning_attempts=-1,
        planner_id="RRTConnectkConfigDefault",
        planning_pipeline_id="ompl",
    )
    if not call(node, TmsRpExcavatorParamSet, f"{name}_param_set", settings).success:
        sys.exit("not set")
    wanted = TmsRpExcavatorJointValues(joint_names=pairs[::2], joint_values=list(map(float, pairs[1::2])))
    goal = TmsRpExcavator.Goal(command=TmsRpExcavator.Goal.CMD_PLAN_TO_JOINTS, joint_values=wanted)
    status, result, _ = ask(node, TmsRpExcavator, name, goal)
    print(status, result.moveit_error_code)
    several = hasattr(goal, "plans")
    what = {"plans": [result.plan]} if several else {"plan": result.plan}
    goal = TmsRpExcavator.Goal(command=TmsRpExcavator.Goal.CMD_EXECUTE_PLAN, **what)
    status, result, _ = ask(node, TmsRpExcavator, name, goal)
    request = TmsRpExcavatorParamGet.Request(get_current_state=True)
    state = call(node, TmsRpExcavatorParamGet, f"{name}_param_get", request).joint_states
    angles = dict(zip(state.name, state.position, strict=True))
    print(status, result.moveit_error_code, *(f"{angles[joint]:.1f}" for joint in pairs[::2]))


def planner(node, machine):
    def execute(handle):
        goal = handle.request
        begins = [list(one.joint_trajectory.points[-1].positions)[:4] for one in goal.previous_pose]
        print(goal.command, goal.planning_group, *(f"{angle:.1f}" for one in begins for angle in one), flush=True)
        result = TmsRpExcavator.Result(success=True, moveit_error_code=1)
        made = result.plan.joint_trajectory
        made.joint_names = goal.joint_values.joint_names
        still = [0.0] * len(made.joint_names)
        start = begins[-1] if begins else START
        for seconds, angles in ((0, start), (10, goal.joint_values.joint_values)):
            point = JointTrajectoryPoint(positions=angles, velocities=still, accelerations=still)
            point.time_from_start.sec = seconds
            made.points.append(point)
        handle.succeed()
        return result

    def settled(_, response):
        response.success = True
        return response

    name = f"/{machine}/tms_rp_excavator"
    node.create_service(TmsRpExcavatorParamSet, f"{name}_param_set", settled)
    server = ActionServer(node, TmsRpExcavator, name, execute)
    print("ready", flush=True)
    rclpy.spin(node)
    server.destroy()


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
    modes = {"leaf": leaf, "rp": rp, "template": template, "plan": plan, "excavator": excavator, "planner": planner,
             "serve": serve}  # fmt: skip
    modes[sys.argv[1]](rclpy.create_node("upstream"), *sys.argv[2:])
