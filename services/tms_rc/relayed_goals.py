"""Goals of foreign clients that processes of ours pass on, which alone can bring their cancel.

When such a process is lost, its goal is cancelled here as its client would, so that no machine goes on that nobody
could stop by the way on which its motion was asked for. It stays armed: the client may ask again.
"""

from tms_decision.gateway.state import Gateway
from tms_decision.owner import parse
from tms_decision.permit_link import NOBODY, PermitLink
from tms_machine.border import RELAYING
from tms_machine.permit import RemotePermit
from tms_machine.reasons import BorderLost
from tms_rc.motion_servers import MotionServers
from tms_ros.server import AnyGoal
from tms_runtime.app import App
from tms_runtime.fence import same_client


def watch(app: App, servers: MotionServers) -> None:
    """Watch the border, where the site file lets primitives of version 6 move this machine."""
    peer = app.site.file.peers.get(app.machine)
    if peer is None or not (peer.motions and app.site.other_form(app.machine)):
        return

    def changed(border: RemotePermit) -> None:
        for goal in servers.goals():
            if border.lost(goal.uuid):
                _cancel(app, goal, "if")

    RemotePermit(app.ros, app.pulse, app.machine, RELAYING, changed)


def look(app: App, servers: MotionServers, gateway: Gateway, now: float) -> None:
    """Look for goals whose planner or subtask is lost; those of runs depend on permits (tms_decision/chain.py)."""
    for goal in servers.goals():
        if parse(goal.uuid) is None and not goal.cancelled.is_set():
            for process in lost_behind(gateway, goal.uuid, now):
                _cancel(app, goal, process)


def lost_behind(gateway: Gateway, uuid: bytes, now: float) -> list[str]:
    """The processes that were lost while they worked for a foreign client's goal."""
    return [name for name, link in gateway.links.items() if same_client(link.goal, uuid) and _lost(link, now)]


def _lost(link: PermitLink, now: float) -> bool:
    return link.goal != NOBODY and not link.alive(now)


def _cancel(app: App, goal: AnyGoal, process: str) -> None:
    app.log.warning("cancelled", goal=goal.id, reason=BorderLost(f"{app.machine}:{process}"))
    goal.cancel()
