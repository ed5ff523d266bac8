"""`tms places`: who holds which shared place, who waits for it, and taking one from its holder."""

import getpass
from typing import TYPE_CHECKING, Any

import click

from tms_cli import live, session
from tms_cli.reasons import PlacesUntold
from tms_cli.words import Group, padded, reason, say, with_advice
from tms_reason.errors import RosError

if TYPE_CHECKING:
    from builtin_interfaces.msg import Time
    from tms_msg_areas.msg import Place, Places

    from tms_ros.node import Ros

STATES = ("free", "granted", "held", "leaving", "revoked")  # by their numbers in the message


@click.group(cls=Group, invoke_without_command=True)
@session.json_option
@click.pass_context
def command(context: click.Context, as_json: bool) -> None:
    """Show who holds which shared place (release area), since when, and who waits for it.

    \b
    Examples:
      tms places
      tms places revoke road
      tms places --json
    """
    if context.invoked_subcommand is not None:
        return
    with session.ros() as node:
        told = _told(node)
    if as_json:
        alarms = [reason(line) for line in told.alarms]
        session.show_json({"places": [_as_dict(place) for place in told.places], "alarms": alarms})
        return
    for place in told.places:
        _show(place)
    for line in told.alarms:
        click.echo(with_advice(line), err=True)
    if not told.places:
        click.echo(say("there are no shared places"), err=True)


@command.command()
@click.argument("name")
@click.option("--by", "who", default=getpass.getuser, help="Who takes it (default: your user name).")
@click.option("--yes", is_flag=True, help="Do not ask; for scripts whose user has decided.")
@session.json_option
def revoke(name: str, who: str, yes: bool, as_json: bool) -> None:
    """Take a shared place from its holder.

    A machine that is inside is stopped, or may only drive out, as its area says. Others get the place once it has
    left, as that machine's gateway tells.

    \b
    Examples:
      tms places revoke road
      tms places revoke road --by "T. Yamada" --yes
    """
    from tms_msg_areas.srv import RevokePlace

    with session.ros() as node:
        if not yes:
            place = next((one for one in _told(node).places if one.name == name), None)
            if place is not None:
                _show(place)
            click.confirm(say("Take {place} from its holder?", place=name), abort=True, err=True)
        answer = session.call(node, RevokePlace, "/tms/places/revoke", place=name, who=who)
    if as_json:
        session.show_json({"place": name, "holder": answer.holder, "by": who})
    else:
        click.echo(say("{place}: taken from {holder}", place=name, holder=answer.holder))


def _told(node: "Ros") -> "Places":
    from tms_msg_areas.msg import Places

    found = session.latched(node, Places, "/tms/places")
    if found is None:
        raise RosError(PlacesUntold("tms:db"))
    return found


def _show(place: "Place") -> None:
    """One line for people, and one for each who waits."""
    words = (say("free"), say("granted"), say("held"), say("leaving"), say("revoked"))
    since = f"{place.holder} {_when(place.since)}" if place.holder else ""
    click.echo(f"{padded(place.name, 16)} {padded(words[place.state], 12)} {since}  {reason(place.reason)}".rstrip())
    for one in place.queue:
        click.echo("  " + say("{machine} waits since {since}", machine=one.machine, since=_when(one.since)))


def _as_dict(place: "Place") -> dict[str, Any]:
    queue = [{"machine": one.machine, "run": one.run, "since": live.iso(one.since)} for one in place.queue]
    return {
        "name": place.name, "state": STATES[place.state], "holder": place.holder or None, "run": place.run or None,
        "since": live.iso(place.since), "queue": queue, "reason": reason(place.reason) or None,
    }  # fmt: skip


def _when(stamp: "Time") -> str:
    moment = live.moment(stamp)
    return "" if moment is None else moment.strftime("%H:%M:%S")
