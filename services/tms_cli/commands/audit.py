"""`tms audit`: show who gave which command, and check that these entries were not changed."""

import sqlite3
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import click

from tms_cli import live, session
from tms_cli.reasons import Unreadable
from tms_cli.words import Group, say
from tms_reason.errors import TmsError

if TYPE_CHECKING:
    from tms_msg_db.msg import Event

    from tms_ros.node import Ros
    from tms_ur.audit_chain import AuditEntry, ChainCheck, ChainFault, ChainHead

PAGE = 1000
MAX_ENTRIES = 10_000


@click.group(cls=Group)
def command() -> None:
    """Show who commanded what from the console and its API, and check that it was not changed since.

    \b
    Examples:
      tms audit list
      tms audit verify
    """


@command.command("list")
@click.option("--limit", default=50, show_default=True, type=click.IntRange(1, MAX_ENTRIES), help="How many.")
@session.json_option
def list_(limit: int, as_json: bool) -> None:
    """List the last commands, oldest first.

    \b
    Examples:
      tms audit list
      tms audit list --limit 500 --json
    """
    with session.ros() as node:
        found = _newest(node, limit)
    if as_json:
        session.show_json([_as_dict(event) for event in found])
        return
    for event in found:
        click.echo(_line(event))
    if not found:
        click.echo(say("no command was given"), err=True)


@command.command()
@session.json_option
def verify(as_json: bool) -> None:
    """Check the chain of the entries in the database; exit code 1 if one is missing, changed or out of order.

    Each entry carries the hash of the one before. On the PC of the console the end is compared, too, with what the
    console remembers; elsewhere it cannot be seen that the last entries are missing.

    \b
    Examples:
      tms audit verify
      tms audit verify --json
    """
    remembered = _remembered()
    with session.ros() as node:
        chain = _checked(node, remembered)
    if as_json:
        session.show_json(_report(chain, remembered is not None))
    else:
        _show(chain, remembered is not None)
    if not chain.intact:
        click.get_current_context().exit(1)


def _remembered() -> "ChainHead | None":
    """The last stored entry by the ledger of this PC. Read before the entries, since more may come meanwhile."""
    from tms_ur.audit_ledger import reported

    file = session.site().state / "audit.db"
    try:
        return reported(file)
    except sqlite3.Error as error:
        raise TmsError(Unreadable(str(file), str(error))) from error


def _checked(node: "Ros", remembered: "ChainHead | None") -> "ChainCheck":
    from tms_ur.audit_chain import ChainCheck

    chain, waiting = ChainCheck(), remembered
    for event in _entries(node, 0):
        chain.add(_entry(event))
        if waiting is not None and event.number >= waiting.number:
            chain.end(waiting)
            waiting = None
    if waiting is not None:
        chain.end(waiting)
    return chain


def _entry(event: "Event") -> "AuditEntry":
    from tms_machine.values import from_parameters
    from tms_ur.audit_chain import Note, entry

    at = event.stamp.sec * 1000 + event.stamp.nanosec // 1_000_000
    return entry(event.number, Note(at, event.kind, event.node, event.text), from_parameters(event.values))


def _page(node: "Ros", after: int, limit: int) -> "list[Event]":
    from tms_msg_db.srv import ListEvents

    try:
        asked: dict[str, Any] = {"run_id": "audit", "after": after, "limit": limit}
        return list(session.call(node, ListEvents, "/tms/db/list_events", **asked).events)
    except TmsError as error:
        if error.code != "RUN_MISSING":  # there are no entries
            raise
        return []


def _entries(node: "Ros", after: int) -> Iterator["Event"]:
    while True:
        page = _page(node, after, PAGE)
        yield from page
        if len(page) < PAGE:
            return
        after = page[-1].number


def _newest(node: "Ros", limit: int) -> "list[Event]":
    """The last entries. The numbers of entries older than the chain have gaps, so the search goes further back."""
    from tms_ur.audit_chain import highest

    last, back = highest(lambda after: bool(_page(node, after, 1))), limit
    while True:
        after = max(0, last - back)
        found = list(_entries(node, after))
        if after == 0 or len(found) >= limit:
            return found[-limit:]
        back *= 8


def _as_dict(event: "Event") -> dict[str, Any]:
    one = _entry(event)
    return {
        "number": one.number, "stamp": live.iso(event.stamp), "what": event.kind, "target": event.node,
        "who": event.text, "times": one.note.times, "previous": one.previous, "hash": one.hash,
    }  # fmt: skip


def _line(event: "Event") -> str:
    times = _entry(event).note.times
    often = f"  ×{times}" if times > 1 else ""
    return f"{event.number:>10}  {live.clock_time(event.stamp)}  {event.kind:<14}  {event.node}  {event.text}{often}"


def _report(chain: "ChainCheck", compared: bool) -> dict[str, Any]:
    return {
        "intact": chain.intact, "entries": chain.chained, "first": chain.first, "last": chain.last.number,
        "earlier_deleted": chain.cut, "without_chain": chain.older, "end_compared": compared,
        "faults": [vars(one) for one in chain.faults], "faults_found": chain.found,
    }  # fmt: skip


def _show(chain: "ChainCheck", compared: bool) -> None:
    if chain.older:
        click.echo(say("{count} entries are from before there was a chain: not checked", count=chain.older))
    if chain.cut:
        click.echo(say("the chain begins at entry {first}: earlier ones were deleted", first=chain.first))
    if not compared:
        click.echo(say("the console does not run on this PC: whether the last entries are missing is not seen here"))
    for fault in chain.faults:
        click.echo(_fault(fault), err=True)
    if chain.found > len(chain.faults):
        click.echo(say("and {count} more", count=chain.found - len(chain.faults)), err=True)
    count, last = chain.chained, chain.last.number
    if chain.intact:
        click.echo(say("intact: {count} entries, the last one is {last}", count=count, last=last))
    else:
        text = say("NOT intact: {count} faults among {entries} entries", count=chain.found, entries=count)
        click.echo(text, err=True)


def _fault(fault: "ChainFault") -> str:
    if fault.what == "missing":
        return say("entries {first} to {last} are missing", first=fault.number, last=fault.until)
    reported = {
        "changed": say("entry {number} was changed", number=fault.number),
        "out_of_order": say("entry {number} does not follow the one before", number=fault.number),
        "no_hash": say("entry {number} has no hash: it was not written by this console", number=fault.number),
    }
    return reported[fault.what]
