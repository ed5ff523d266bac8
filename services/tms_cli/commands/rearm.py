"""`tms rearm`: let stopped machines move again, in two steps, by a person who has looked at them."""

import getpass
from typing import TYPE_CHECKING, Any

import click

from tms_cli import session, words
from tms_cli.words import say
from tms_decision.reasons import NoNote
from tms_reason import wire
from tms_reason.errors import TmsError

if TYPE_CHECKING:
    from tms_msg_rc.msg import MachineState
    from tms_msg_rc.srv import Rearm

    from tms_ros.node import Ros

ARMED = "NOT_STOPPED"  # error code of a gateway whose machine is armed already


def ask(node: "Ros", machine: str, token: str = "") -> "Rearm.Response":
    """Do one step of re-arming.

    Raises:
        TmsError: refused, with the reason.
    """
    from tms_msg_rc.srv import Rearm

    return session.call(node, Rearm, f"/{machine}/rearm", token=token)


def never_armed(state: "MachineState | None") -> bool:
    """Whether a machine is stopped only because this PC has no note of its last state."""
    return state is not None and isinstance(wire.of(state.latch), NoNote)


@click.command()
@click.argument("machines", nargs=-1)
@click.option("--all", "every", is_flag=True, help="Every machine of the site that is stopped, one after another.")
@click.option("--escape", is_flag=True, help="It stands outside its areas: let it back in, slowly.")
@click.option("--by", "who", default=getpass.getuser, help="With --escape: who lets it (default: your user name).")
@click.option("--yes", is_flag=True, help="Do not ask; for scripts that have made sure that nobody is in danger.")
@session.json_option
def command(machines: tuple[str, ...], every: bool, escape: bool, who: str, yes: bool, as_json: bool) -> None:
    """Arm machines again after a stop, or after the first start, when it is not known how a machine was left.

    Shows why each was stopped and asks. Refused while it has an open goal, still moves, does not report, or while the
    software stop is pressed.

    With --escape, a machine that stands where its areas forbid it may be moved back: tracks at 0.2 m/s at most, tracks
    and arm only further in. That ends once it is inside with its margin, or at a stop.

    \b
    Examples:
      tms rearm zx200
      tms rearm --all
      tms rearm zx200 --escape --by "mina"
    """
    chosen = session.machines(machines, every)
    if escape and (every or len(chosen) != 1):
        raise click.UsageError(say("--escape is for one machine"))
    with session.ros() as node:
        if escape:
            told = _let_back(node, chosen[0], who, yes)
            if as_json:
                session.show_json(told)
            return
        armed = [one for machine in chosen if (one := _rearm(node, machine, yes, optional=every)) is not None]
    if as_json:
        session.show_json(armed if every or len(armed) != 1 else armed[0])


def _let_back(node: "Ros", machine: str, who: str, yes: bool) -> dict[str, Any]:
    """Re-arm a machine if it is stopped, and let it be moved back into its areas."""
    from tms_ur import gateway_areas

    stopped = _rearm(node, machine, yes, optional=True)
    gateway_areas.let_back(node, machine, who)
    click.echo(say("{machine} may be moved back in, slowly", machine=machine), err=True)
    return {"machine": machine, "armed": True, "cause": stopped["cause"] if stopped else "", "escape": who}


def _rearm(node: "Ros", machine: str, yes: bool, optional: bool) -> dict[str, Any] | None:
    """Re-arm a machine; None if it is armed already and `optional` allows that."""
    try:
        first = ask(node, machine)
    except TmsError as error:
        if optional and error.code == ARMED:
            return None
        raise
    click.echo(say("{machine} was stopped: {cause}", machine=machine, cause=words.reason(first.cause)), err=True)
    if not yes:
        click.confirm(say("Is it safe that {machine} moves again?", machine=machine), abort=True, err=True)
    ask(node, machine, first.token)
    click.echo(say("{machine} is armed", machine=machine), err=True)
    return {"machine": machine, "armed": True, "cause": first.cause}
