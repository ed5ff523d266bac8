"""Process `<machine>:rc`: the machine's gateway. Its stops need no database, no scheduler and no console."""

import threading

from tms_config.clock import monotonic, unix_time
from tms_decision.gateway.effects import CancelAll, Emergency, Zero
from tms_decision.gateway.events import Beat
from tms_decision.gateway.state import Gateway
from tms_decision.gateway.step import start as begun
from tms_decision.permit_link import LEASE
from tms_machine.border import Controls, motions
from tms_machine.facts import facts_of
from tms_machine.permit import Permit
from tms_rc import areas, permits, relayed_goals, watch_setup
from tms_rc.claim import Claim
from tms_rc.disk import Disk
from tms_rc.holder import Holder
from tms_rc.latch_file import LatchFile
from tms_rc.machine_monitor import MachineMonitor
from tms_rc.motion_servers import MotionServers
from tms_rc.people import People
from tms_rc.reasons import LooksForRivals
from tms_rc.receipts import Receipts
from tms_rc.shell import Shell
from tms_rc.state_topic import StateTopic
from tms_rc.stop_receipt import ReceiptTopic
from tms_runtime.app import App

GATEWAY = bytes([255]) * 16  # the goal in the gateway's own permit: it stands behind the machine itself


def start(app: App) -> None:
    """Serve motion, stop and re-arm of one machine and publish its state, unless another gateway does."""
    threading.Thread(target=_begin, args=(app, Claim(app)), name="claim", daemon=True).start()


def _begin(app: App, claim: Claim) -> None:
    over = False
    try:
        _serve(app, claim)
        over = True
    finally:
        if not over and not app.ros.closing:  # a bug: half a gateway must not stay
            app.ros.failed.set()


def _serve(app: App, claim: Claim) -> None:
    app.ready_when(lambda: claim.rival or LooksForRivals())
    if not claim.serve():
        return
    border, machine = app.site.border(app.machine), app.machine
    controls, notes = Controls(app.ros, machine, border), LatchFile(app.site.state, machine)
    facts, left = facts_of(app.site, machine), notes.read()
    gateway, effects = begun(facts, app.process.full, permits.names_of(app), left, monotonic(), unix_time())
    shell, monitor = Shell(app, gateway), MachineMonitor(app, gateway.watch)
    servers = MotionServers(app, shell)
    kept = Receipts(app.site.state, machine)
    state = StateTopic(app, shell, monitor, servers, claim)
    receipts = ReceiptTopic(app, shell, kept)
    Disk(app, shell, notes, kept)
    drives: Controls | Holder = controls
    if border.controller == "ours":
        drives = Holder(app, controls, lambda: gateway.watch.seen(monotonic()))
    shell.does(Zero, lambda _: drives.zero())
    shell.does(Emergency, lambda effect: drives.emergency(effect.on))
    shell.does(CancelAll, lambda _: controls.cancel_everything())

    def look(seen: Gateway) -> Beat:
        relayed_goals.look(app, servers, seen, monotonic())
        ready, gone, escaped = servers.look(seen)
        reachable = seen.recovery.reached or controls.reachable()  # asked of the graph at the start only
        return Beat(unix_time(), reachable, drives.settling(), ready, gone, escaped)

    areas.begin(app, gateway, servers, receipts)
    shell.begin(effects, monitor.samples, look)
    for motion in motions(border):
        servers.serve(motion, getattr(border, motion.field))
    people = People(app, shell, border)
    watch_setup.begin(app, shell, gateway, servers, people)
    relayed_goals.watch(app, servers)
    app.ros.on_executor(lambda: permits.listen(app, shell))  # no callback may come before all of them exist
    _stand_by_goals(app)
    app.ready_when(state.unready)


def _stand_by_goals(app: App) -> None:
    permit = Permit(app.ros, app.pulse, app.machine, "rc")
    # Wait until the lease of a killed predecessor has run out: before, its loss would go unnoticed.
    app.ros.on_executor(lambda: app.ros.after(LEASE, lambda: permit.hold(GATEWAY)))
