"""`tms sensing`: show the state of the sensing inputs; `tms sensing replay` plays a recording into them."""

import math
from typing import TYPE_CHECKING, Any

import click

from tms_cli import session, words
from tms_cli.reasons import SensingSilent
from tms_cli.replay.verb import replay
from tms_cli.words import Group, say
from tms_reason.errors import TmsError

if TYPE_CHECKING:
    from tms_msg_sp.msg import InputState


@click.group(cls=Group, invoke_without_command=True)
@session.json_option
@click.pass_context
def command(ctx: click.Context, as_json: bool) -> None:
    """Show the sensing inputs: what is received, at which rate, and what was refused and why.

    An input is waiting (nothing came yet), alive, silent (10 periods of its declared rate without a message) or
    clock (the clock of its PC is off). configs/sensing.yaml declares the inputs.

    \b
    Examples:
      tms sensing
      tms sensing --json
      tms sensing replay rosbag2_2026_04_01 --speed 20
    """
    if ctx.invoked_subcommand is not None:
        return
    rows = [_row(one) for one in _inputs()]
    if as_json:
        session.show_json(rows)
        return
    click.echo(f"{'INPUT':<28} {'STATE':<8} {'HZ':>7} {'AGE':>9} {'ACCEPTED':>9} {'REFUSED':>8} {'CLOCK':>8}  TOPIC")
    for row in rows:
        age = "-" if row["age"] is None else f"{row['age']:.1f} s"
        clock = "-" if row["clock_offset"] is None else f"{row['clock_offset']:+.2f} s"
        click.echo(
            f"{row['name']:<28} {row['state']:<8} {row['hz']:>7.1f} {age:>9} {row['accepted']:>9} {row['refused']:>8} "
            f"{clock:>8}  {row['topic']}"
        )
        if row["last_refusal"]:
            click.echo("    " + say("last refused: {reason}", reason=words.reason(row["last_refusal"])))


command.add_command(replay)


def _inputs() -> "list[InputState]":
    """The inputs that tms:sp reports.

    Raises:
        TmsError: tms:sp does not report them.
    """
    from tms_msg_sp.msg import InputStates

    with session.ros() as node:
        received = session.latched(node, InputStates, "/tms/sp/inputs")
    if received is None:
        raise TmsError(SensingSilent(), "NO_ANSWER")
    return list(received.inputs)


def _row(one: "InputState") -> dict[str, Any]:
    return {
        "name": one.name,
        "topic": one.topic,
        "type": one.type,
        "state": one.state,
        "hz": round(one.hz, 2),
        "hz_expected": one.hz_expected or None,
        "age": round(one.age, 3) if one.age >= 0 else None,
        "clock_offset": None if math.isnan(one.clock_offset) else round(one.clock_offset, 3),
        "accepted": one.accepted,
        "written": one.written,
        "superseded": one.superseded,
        "refused": one.refused,
        "last_refusal": one.last_refusal,
        "records": list(one.records),
    }
