"""Receives the permits of all processes that may stand behind a goal of this machine."""

from tms_msg_rc.msg import Permit

from tms_decision.gateway.events import PermitHeard, PermitReported
from tms_decision.gateway.state import SCHEDULER
from tms_decision.permit_link import LEASE
from tms_machine.permit import topic
from tms_rc.shell import Shell
from tms_runtime import leases
from tms_runtime.app import App


def names_of(app: App) -> list[str]:
    """The processes that may stand behind a goal, besides the scheduler."""
    model = app.site.model_of(app.machine)
    return [*(["rp"] if model.planner else []), *model.subtasks]


def listen(app: App, shell: Shell) -> None:
    """Receive their permits; on the executor thread."""
    for name in (SCHEDULER, *names_of(app)):
        _listen(app, shell, name)


def _listen(app: App, shell: Shell, name: str) -> None:
    leases.subscribe(
        app.ros, Permit, topic(app.machine, name), LEASE,
        lambda message: shell.happened(PermitHeard(name, bytes(message.goal), message.holder)),
        lambda alive, not_alive: shell.happened(PermitReported(name, alive, not_alive, app.pulse.late())),
    )  # fmt: skip
