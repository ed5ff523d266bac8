"""`tms give-back`: end driving by hand; the gateway proves that the machine stands."""

import getpass

import click

from tms_cli import session, words
from tms_cli.commands import stop
from tms_cli.words import say

PROOF_LIMIT = 20.0  # s for the gateway to prove that it stands


@click.command()
@click.argument("machine")
@click.option("--by", "who", default=getpass.getuser, help="Who gives it back (default: your user name).")
@session.json_option
@click.pass_context
def command(ctx: click.Context, machine: str, who: str, as_json: bool) -> None:
    """Give a machine back that was taken with `tms take`. Exit code 0 only when it was seen to stand.

    \b
    Example:
      tms give-back zx200
    """
    from tms_msg_rc.srv import TakeMachine

    session.machines((machine,), False)
    with session.ros() as node:
        answer = session.call(node, TakeMachine, f"/{machine}/take", seconds=PROOF_LIMIT, who=who, back=True)
    receipt = answer.receipt
    if as_json:
        session.show_json(stop.as_dict(receipt))
    elif receipt.confirmed:
        text = "{machine}: given back, seen to stand after {seconds:.2f} s"
        click.echo(say(text, machine=machine, seconds=receipt.seconds))
    else:
        click.echo(say("{machine}: STOP UNCONFIRMED: {detail}", machine=machine, detail=words.reason(receipt.detail)))
    ctx.exit(0 if receipt.confirmed else 1)
