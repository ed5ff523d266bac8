"""`tms take`: a person drives a machine by hand; no process moves it, and none commands anything against the person."""

import getpass

import click

from tms_cli import session
from tms_cli.words import say


@click.command()
@click.argument("machine")
@click.option("--by", "who", default=getpass.getuser, help="Who drives (default: your user name).")
@session.json_option
def command(machine: str, who: str, as_json: bool) -> None:
    """Take a machine to drive it by hand, with its levers or a remote control.

    A stopped machine that moves without a goal is stopped again and again, by all means there are; while it is taken,
    it is only watched. Goals are refused meanwhile. `tms give-back` ends it.

    \b
    Example:
      tms take zx200 --by "mina"
    """
    from tms_msg_rc.srv import TakeMachine

    session.machines((machine,), False)
    with session.ros() as node:
        session.call(node, TakeMachine, f"/{machine}/take", who=who)
    if as_json:
        session.show_json({"machine": machine, "by_hand": who})
    else:
        click.echo(say("{machine}: {who} drives by hand", machine=machine, who=who))
