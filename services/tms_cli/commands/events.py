"""`tms events`: the journal of one run."""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import click

from tms_cli import live, session, words
from tms_cli.commands.runs import MAX_RUNS, find_run, has_ended, history, recent
from tms_config.clock import sleep

if TYPE_CHECKING:
    from tms_msg_db.msg import Event

    from tms_ros.node import Ros

PAGE = 1000
CHECK_PERIOD = 0.5  # s between reads with --follow
COLOURS = {"run": "cyan", "goal": "yellow", "stop": "red"}


def journal(node: "Ros", run_id: str, after: int = 0) -> Iterator["Event"]:
    """All events of a run with a number above `after`, page by page."""
    from tms_msg_db.srv import ListEvents

    while True:
        page = session.call(node, ListEvents, "/tms/db/list_events", run_id=run_id, after=after, limit=PAGE).events
        yield from page
        if len(page) < PAGE:
            return
        after = page[-1].number


def _follow(node: "Ros", run_id: str) -> None:
    """Show events as they come until the run has ended."""
    after, places = 0, dict[str, str]()
    while True:
        # Read before the events, since the end of a run is stored after its last event.
        run = recent(node, run_id)
        ended = run is None or has_ended(run)
        for event in journal(node, run_id, after):
            click.echo(_line(event, places))
            after = event.number
        if ended:
            return
        sleep(CHECK_PERIOD)


def _as_dict(event: "Event") -> dict[str, Any]:
    from tms_machine.values import from_parameters

    return {
        "run_id": event.run_id,
        "number": event.number,
        "stamp": live.iso(event.stamp),
        "kind": event.kind,
        "node": event.node,
        "text": words.english(event.text),
        "values": from_parameters(event.values),
    }


def _line(event: "Event", places: dict[str, str]) -> str:
    """A line for people; `places` keeps which node comes from which template, as the event `tree` tells."""
    from tms_machine.values import from_parameters

    when = live.moment(event.stamp)
    clock = when.strftime("%H:%M:%S.") + f"{when.microsecond // 1000:03}" if when else "-" * 12
    kind = click.style(f"{event.kind:<6}", fg=COLOURS.get(event.kind))
    found = from_parameters(event.values)
    if event.kind == "tree":
        places.update(zip(_texts(found.get("paths")), _texts(found.get("templates")), strict=False))
    place = f"({template})" if (template := places.get(event.node)) else ""
    values = "  ".join(f"{name}={value}" for name, value in found.items())
    parts = (f"{event.number:>5} {clock} {kind}", event.node, place, words.reason(event.text), values)
    return "  ".join(part for part in parts if part)


def _texts(value: object) -> list[str]:
    return value if isinstance(value, list) else []


@click.command()
@click.argument("run")
@click.option("-f", "--follow", is_flag=True, help="Go on until the run has ended.")
@session.json_option
def command(run: str, follow: bool, as_json: bool) -> None:
    """Show what happened in a run, in order.

    RUN is its id, the beginning of it, or `last` for the newest run.

    \b
    Examples:
      tms events last
      tms events last --follow
    """
    if follow and as_json:
        raise click.UsageError("--follow and --json do not go together: --json is one finished document")
    with session.ros() as node:
        run_id = find_run(history(node, MAX_RUNS), run).run_id
        if follow:
            _follow(node, run_id)
            return
        events = list(journal(node, run_id))
    if as_json:
        session.show_json([_as_dict(event) for event in events])
        return
    places: dict[str, str] = {}
    for event in events:
        click.echo(_line(event, places))
