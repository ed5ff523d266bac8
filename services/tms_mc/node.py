"""Process `<machine>:mc`: serves the actions of a machine's border, and commands its drives."""

from control_msgs.action import FollowJointTrajectory
from nav2_msgs.action import ComputePathToPose, FollowPath, FollowWaypoints, NavigateThroughPoses, NavigateToPose

from tms_control.verdict import Ending
from tms_mc.gateway_watch import GatewayWatch
from tms_mc.goal_poses import refuse
from tms_mc.guard import Guard
from tms_mc.joint_servers import TURNS, JointServers
from tms_mc.joints import Joints
from tms_mc.path_server import PathServer
from tms_mc.surroundings import Surroundings
from tms_mc.track_servers import TrackServers
from tms_mc.tracks import Tracks
from tms_mc.way_teller import WayTeller
from tms_runtime.app import App


def start(app: App) -> None:
    """Serve what the border names."""
    gateway = GatewayWatch(app)
    guard = Guard(app, gateway)
    app.ready_when(guard.unready)
    _serve_tracks(app, guard, gateway, _serve_joints(app, guard, gateway))


def _serve_joints(app: App, guard: Guard, gateway: GatewayWatch) -> Joints:
    border, machine = app.site.border(app.machine), app.machine
    joints = Joints(app, gateway)
    guard.watch(joints.unready, lambda: joints.stands, lambda why: joints.stop(why, Ending.ABORTED))
    servers = JointServers(joints, guard)
    if border.trajectory:
        name = f"/{machine}/{border.trajectory}"
        app.ros.serve(FollowJointTrajectory, name, servers.follow, servers.refuse_trajectory)
    for field in TURNS:
        if own := getattr(border, field):
            action, run, refuse = servers.turn(field)
            app.ros.serve(action, f"/{machine}/{own}", run, refuse)
    return joints


def _serve_tracks(app: App, guard: Guard, gateway: GatewayWatch, joints: Joints) -> None:
    border, drive = app.site.border(app.machine), app.site.model_of(app.machine).drive
    if drive is None or not border.pose or not border.cmd_vel:
        return
    tracks = Tracks(app, gateway, drive, joints)
    guard.watch(tracks.unready, lambda: tracks.stands, lambda _: tracks.stop())
    around = Surroundings(app)
    servers = TrackServers(tracks, guard, around, WayTeller(app))
    for field, action, run in (
        ("navigate_to_pose", NavigateToPose, servers.to_pose),
        ("navigate_through_poses", NavigateThroughPoses, servers.through_poses),
        ("follow_waypoints", FollowWaypoints, servers.waypoints),
        ("follow_path", FollowPath, servers.path),
    ):
        if own := getattr(border, field):
            app.ros.serve(action, f"/{app.machine}/{own}", run, refuse)
    if border.compute_path_to_pose:
        planner = PathServer(tracks, around)
        app.ros.serve(ComputePathToPose, f"/{app.machine}/{border.compute_path_to_pose}", planner.run, planner.refuse)
