"""`tms stop`: software stop of all machines or of one; each stays stopped until it is re-armed."""

from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING, Any

import click

from tms_cli import live, session, words
from tms_cli.words import say
from tms_config.reasons import NoMachine
from tms_decision.reasons import SoftwareStop
from tms_reason.errors import ConfigError, RosError
from tms_reason.wire import to_line
from tms_runtime.priority import URGENT, undisturbed

if TYPE_CHECKING:
    from tms_msg_rc.msg import StopReceipt

    from tms_ros.node import Ros

ANSWER_LIMIT = 13.0  # s; a gateway takes at most 10 s to see the machine stand
CAUSE = to_line(SoftwareStop())


def stop(node: "Ros", machine: str) -> "StopReceipt":
    """Stop a machine; returns the gateway's receipt, or one that says why there is none."""
    from tms_msg_rc.msg import StopReceipt
    from tms_msg_rc.srv import StopMachine

    try:
        request = StopMachine.Request(cause=CAUSE)
        with undisturbed(URGENT):
            return node.call(StopMachine, f"/{machine}/rc/stop", request, ANSWER_LIMIT).receipt
    except RosError as error:
        return StopReceipt(machine=machine, confirmed=False, cause=CAUSE, detail=to_line(error.reason))


def stop_all(node: "Ros", machines: list[str]) -> "list[StopReceipt]":
    """Stop all machines at the same time, each by a call of its gateway."""
    with ThreadPoolExecutor(max(1, len(machines)), "stop") as pool:
        return list(pool.map(lambda machine: stop(node, machine), machines))


def as_dict(receipt: "StopReceipt") -> dict[str, Any]:
    """A receipt for --json."""
    return {
        "machine": receipt.machine,
        "confirmed": receipt.confirmed,
        "seconds": round(receipt.seconds, 3),
        "travel_joint": receipt.travel_joint,
        "travel_rad": round(receipt.travel_rad, 4),
        "travel_m": round(receipt.travel_m, 3),
        "evidence": words.english(receipt.evidence),
        "latched": receipt.latched,
        "cause": words.english(receipt.cause),
        "detail": words.english(receipt.detail),
        "stamp": live.iso(receipt.stamp),
    }


def _line(receipt: "StopReceipt") -> str:
    if receipt.confirmed:
        return say(
            "{machine}: stands, after {seconds:.2f} s and {angle:.3f} rad, {way:.2f} m; latched",
            machine=receipt.machine,
            seconds=receipt.seconds,
            angle=receipt.travel_rad,
            way=receipt.travel_m,
        )
    line = say("{machine}: STOP UNCONFIRMED: {detail}", machine=receipt.machine, detail=words.reason(receipt.detail))
    return click.style(line, fg="red", bold=True)


@click.command()
@click.argument("machine", required=False)
@session.json_option
@click.pass_context
def command(ctx: click.Context, machine: str | None, as_json: bool) -> None:
    """Software stop: stop every machine, or one, and keep it stopped until `tms rearm`.

    Runs that use a stopped machine end. This is no emergency stop in the sense of ISO 13850. Exit code 0 only when
    every machine was seen to stand still.

    \b
    Examples:
      tms stop
      tms stop zx200
    """
    machines = list(session.site().file.machines)
    if machine is not None and machine not in machines:
        raise ConfigError(NoMachine(machine, tuple(machines)))
    with session.ros() as node:
        receipts = stop_all(node, machines if machine is None else [machine])
    if as_json:
        session.show_json([as_dict(receipt) for receipt in receipts])
    else:
        for receipt in receipts:
            click.echo(_line(receipt))
        click.echo(say("`tms rearm MACHINE` lets a machine move again"), err=True)
    ctx.exit(0 if all(receipt.confirmed for receipt in receipts) else 1)
