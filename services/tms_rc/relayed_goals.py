"""Goals of primitives of version 6 of the C++ system: they come through `<machine>:if`, which alone can bring a cancel.

When that process is lost, its goal is cancelled here as its client would, so that no machine goes on that nobody
could stop by the way on which its motion was asked for.
"""

from tms_machine.border import RELAYING
from tms_machine.permit import RemotePermit
from tms_machine.reasons import BorderLost
from tms_rc.motion_servers import MotionServers
from tms_runtime.app import App


def watch(app: App, servers: MotionServers) -> None:
    """Watch the border, where the site file lets primitives move this machine."""
    peer = app.site.file.peers.get(app.machine)
    if peer is None or not (peer.motions and app.site.other_form(app.machine)):
        return

    def changed(border: RemotePermit) -> None:
        for goal in servers.goals():
            if border.lost(goal.uuid):
                app.log.warning("cancelled", goal=goal.id, reason=BorderLost(f"{app.machine}:if"))
                goal.cancel()

    RemotePermit(app.ros, app.pulse, app.machine, RELAYING, changed)
