"""Motions under the names that primitives of version 6 call (`tms_rp_...`), where the site file says so.

There another program of that system serves them (irvs/tms_if_for_opera), and two servers of one name would both move
the machine: so it is off by default. Each goal goes to the gateway as it is, with its UUID.
"""

from tms_if.relay import Relay
from tms_machine.border import motions
from tms_runtime.app import App

# Key under borders: -> what primitives of version 6 call; the types are those of the machine's own actions.
NAMES = {
    "navigate_to_pose": "tms_rp_navigate_anywhere",
    "navigate_through_poses": "tms_rp_navigate_through_poses",
    "follow_waypoints": "tms_rp_navigate_follow_waypoints",
    "set_bulldozer_blade": "tms_rp_set_bulldozer_blade",
}


def serve(app: App) -> None:
    """Serve the motions that the machine has."""
    for motion in motions(app.site.border(app.machine)):
        if name := NAMES.get(motion.field):
            peer = app.ros.peer(motion.type, f"/{app.machine}/rc/{motion.served}")
            relay = Relay(app.machine, motion.type, peer)
            app.ros.serve(motion.type, f"/{app.machine}/{name}", relay.run, relay.accept)
