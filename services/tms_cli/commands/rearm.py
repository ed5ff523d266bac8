"""`tms rearm`: let a stopped machine move again, in two steps, by a person who has looked at it."""

from typing import TYPE_CHECKING, Any

import click

from tms_cli import session
from tms_cli.words import say
from tms_core.errors import ConfigError

if TYPE_CHECKING:
    from tms_core.ros import Ros


def ask(node: "Ros", machine: str, token: str = "") -> Any:
    """One step of re-arming.

    Raises:
        TmsError: refused, with the reason.
    """
    from tms_msg_rc.srv import Rearm

    return session.call(node, Rearm, f"/{machine}/rearm", token=token)


@click.command()
@click.argument("machine")
@click.option("--yes", is_flag=True, help="Do not ask; for scripts that have made sure that nobody is in danger.")
@session.json_option
def command(machine: str, yes: bool, as_json: bool) -> None:
    """Arm a machine again after a stop.

    Shows why it was stopped and asks. Refused while it has an open goal, still moves, is not heard, or while the
    software stop is pressed.

    \b
    Example:
      tms rearm zx200
    """
    machines = session.site().file.machines
    if machine not in machines:
        raise ConfigError(f"the site has no machine '{machine}' (there: {', '.join(machines) or 'none'})")
    with session.ros() as node:
        first = ask(node, machine)
        click.echo(say("{machine} was stopped: {cause}", machine=machine, cause=first.cause), err=True)
        if not yes:
            click.confirm(say("Is it safe that {machine} moves again?", machine=machine), abort=True, err=True)
        ask(node, machine, first.token)
    if as_json:
        session.show_json({"machine": machine, "armed": True, "cause": first.cause})
    else:
        click.echo(say("{machine} is armed", machine=machine))
