"""Process `sim:<machine>`: the stand-in of one machine with the names of its border; absent names are not served."""

import os
from collections.abc import Callable

from com3_msgs.msg import JointCmd
from geometry_msgs.msg import Twist
from nav2_msgs.action import ComputePathToPose
from pydantic import ValidationError
from std_msgs.msg import Bool, Float64, String
from tms_msg_ground.msg import GroundContact

from tms_config.models import Border
from tms_config.site_file import Fault
from tms_machine.border import speed_limit
from tms_reason.validation import explain
from tms_runtime.app import App
from tms_sim.arm_server import trajectory_server
from tms_sim.blade_server import blade_server
from tms_sim.hardware import PERIOD, HardwareStandIn
from tms_sim.joint_commands import POSITION
from tms_sim.lamp import LampStandIn
from tms_sim.machine import StandIn
from tms_sim.nav_servers import nav_servers
from tms_sim.path_server import PathServer
from tms_sim.servers import ActionHandler, ActionServer
from tms_sim.soil import stance
from tms_sim.telemetry import STEP_PERIOD, Telemetry
from tms_sim.turn_server import TYPES, turn_server


def start(app: App) -> None:
    """Serve actions, commands and telemetry of one machine; /<machine>/sim/fault takes a Fault as JSON."""
    site, name = app.site, app.machine
    border, model, settings = site.border(name), site.model_of(name), site.file.sim
    fault = settings.faults.get(name, Fault())
    machine = StandIn(model, site.start_of(name), fault, lambda: os._exit(1), border,
                      ideal=settings.response == "ideal")  # fmt: skip
    for handler in _handlers(machine, border):
        server = ActionServer(app, machine, handler)
        app.ros.serve(handler.type, f"/{name}/{getattr(border, handler.field)}", server.run, server.accept)
    if (base := machine.base) is not None:
        app.ros.subscribe(Float64, speed_limit(name), lambda m: base.limit(m.data), latched=True)
    if border.compute_path_to_pose and machine.navigator is not None:
        app.ros.serve(ComputePathToPose, f"/{name}/{border.compute_path_to_pose}", PathServer(machine.navigator).run)
    if border.emg_stop:
        app.ros.subscribe(Bool, f"/{name}/{border.emg_stop}", lambda m: machine.stop(m.data), depth=10)
    if border.cmd_vel:
        topic = f"/{name}/{border.cmd_vel}"
        app.ros.subscribe(Twist, topic, lambda m: machine.drive(m.linear.x, m.angular.z), depth=10)
    if border.joint_cmd:
        topic = f"/{name}/{border.joint_cmd}"
        app.ros.subscribe(
            JointCmd, topic, lambda m: machine.turn(m.joint_name, m.control_type, m.position, m.velocity), depth=10
        )
    for joint, topic in border.joint_angles.items():
        app.ros.subscribe(Float64, f"/{name}/{topic}", _angle_of(machine, joint), depth=10)
    app.ros.subscribe(String, f"/{name}/sim/fault", lambda m: _break(app, machine, m.data), depth=10)
    if site.file.ground is not None:
        app.ros.subscribe(GroundContact, f"/{name}/ground_contact", lambda m: _feel(machine, m), latched=True)
    if border.lamp:
        LampStandIn(app, name, border.lamp)
    if site.file.machines[name].hardware:
        hardware = HardwareStandIn(app, name)
        app.ros.every(PERIOD, lambda: hardware.tell(machine.fault))
    app.ros.every(STEP_PERIOD, Telemetry(app, machine, name).tick)
    app.ready_when(lambda: None)


def _feel(machine: StandIn, contact: GroundContact) -> None:
    q = contact.stands.orientation
    machine.feel(contact.resistance, stance(contact.stands.position.z, (q.x, q.y, q.z, q.w)))


def _angle_of(machine: StandIn, joint: str) -> Callable[[Float64], None]:
    return lambda message: machine.turn([joint], POSITION, [message.data], [])


def _handlers(machine: StandIn, border: Border) -> list[ActionHandler]:
    """The actions that this border has."""
    found = [trajectory_server(machine.controller), blade_server(machine.controller)]
    found += [turn_server(field, machine.turner) for field in TYPES if getattr(border, field)]
    if machine.navigator is not None:
        found += nav_servers(machine, machine.navigator)
    return [handler for handler in found if getattr(border, handler.field)]


def _break(app: App, machine: StandIn, text: str) -> None:
    """Set the fault from now on; an empty object means no fault."""
    try:
        machine.fault = Fault.model_validate_json(text or "{}")
    except ValidationError as error:
        app.log.error("bad_fault", text=text, reason=explain(error))
        return
    app.log.warning("fault", fault=machine.fault)
