"""What a gateway watches where the site names it: people and vehicles, and the machine's hardware.

Without these nothing is loaded, heard or told.
"""

from tms_decision.gateway.state import Gateway
from tms_machine.sensing import load_sensing
from tms_rc.motion_servers import MotionServers
from tms_rc.people import People
from tms_rc.shell import Shell
from tms_runtime.app import App


def begin(app: App, shell: Shell, gateway: Gateway, servers: MotionServers, people: People) -> None:
    """Begin the watches, and tell of them.

    Raises:
        ConfigError: what sensing.yaml or the site file names for them cannot be heard.
    """
    if servers.areas is not None and load_sensing(app.site).trackers:
        from tms_rc.intruder_watch import IntruderWatch

        watch = IntruderWatch(app, gateway, servers.areas, servers.drives, people.stop)
        servers.watches.append(watch)
        people.unarmed.append(watch.unarmed)
    if app.site.file.machines[app.machine].hardware:
        from tms_rc.hardware_watch import HardwareWatch

        hardware = HardwareWatch(app, shell, gateway, people.stop)
        servers.watches.append(hardware)
        people.unarmed.append(hardware.unready)
    if servers.watches:
        from tms_rc.watches import WatchTopic

        WatchTopic(app, servers.watches)
