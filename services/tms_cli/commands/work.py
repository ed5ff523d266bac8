"""`tms work`: what the machines have moved, by run, machine, hour or day."""

import csv
import io
from collections.abc import Callable
from datetime import date
from typing import TYPE_CHECKING, Any

import click

from tms_cli import session
from tms_cli.days import Day
from tms_cli.open_store import opened
from tms_cli.words import columns, padded, say

if TYPE_CHECKING:
    from tms_work.cycle import Cycle
    from tms_work.sums import Sum

GROUPS = ("run", "machine", "hour", "day")


@click.command()
@click.option("--run", "run_id", default="", help="Of this run only.")
@click.option("--day", type=Day(), help="Of this day only: a date, today or yesterday.")
@click.option("--machine", default="", help="Of this machine only.")
@click.option("--by", type=click.Choice(GROUPS), default="machine", show_default=True, help="What to sum up by.")
@session.json_option
@click.option("--csv", "as_csv", is_flag=True, help="One line a sum, for spreadsheets.")
def command(run_id: str, day: date | None, machine: str, by: str, as_json: bool, as_csv: bool) -> None:
    """Show the work: cycles, m³ of soil as it lay (bank) and loose, tonnes, truck loads, distance.

    It talks to the store itself: run it on the PC of tms:db, or wherever TMS_MONGODB_URI is known.

    \b
    Examples:
      tms work --day today
      tms work --run last_run_id --by hour
      tms work --machine zx200 --by day --csv
    """
    from tms_db.cycles import Cycles
    from tms_work import sums

    if as_json and as_csv:
        raise click.UsageError(say("give one of --json and --csv"))
    begin, end = sums.span(day) if day is not None else (None, None)
    with opened() as db:
        cycles = Cycles(db).find(run_id, machine, begin, end)
    groups, total = sums.by(cycles, _key(by)), sums.total(cycles)
    if as_json:
        session.show_json({"by": by, "groups": {name: as_dict(one) for name, one in groups.items()},
                           "total": as_dict(total)})  # fmt: skip
    elif as_csv:
        click.echo(_csv(by, groups), nl=False)
    elif not cycles:
        click.echo(say("no work is recorded"), err=True)
    else:
        for line in _table(by, groups, total):
            click.echo(line)
        if total.unseen:
            click.echo(say("{minutes:.1f} min of machine time were not seen: soil moved then is estimated or missing",
                           minutes=total.unseen / 60))  # fmt: skip


def as_dict(one: "Sum") -> dict[str, Any]:
    """A sum for programs; SI units but where the name tells another."""
    return {
        "cycles": one.cycles, "bank_m3": one.bank, "loose_m3": one.loose, "mass_t": one.mass / 1000,
        "fill_factor": one.fill, "truck_loads": one.loads, "hauled_loose_m3": one.hauled, "distance_m": one.distance,
        "seconds": one.digging, "bank_m3_per_hour": one.rate, "mean_cycle_s": one.mean_cycle,
        "measured_cycles": one.measured, "unseen_s": one.unseen, "parts_s": one.parts, "haul_parts_s": one.haul_parts,
    }  # fmt: skip


def _key(by: str) -> "Callable[[Cycle], str]":
    from tms_work import sums

    keys: dict[str, Callable[[Cycle], str]] = {
        "run": lambda one: one.run_id, "machine": lambda one: one.machine, "hour": sums.hour(None),
        "day": sums.day(None),
    }  # fmt: skip
    return keys[by]


def _csv(by: str, groups: "dict[str, Sum]") -> str:
    from tms_work import sums
    from tms_work.cycle import PARTS

    out = io.StringIO()
    names = [name for name in as_dict(sums.total(())) if not name.endswith("parts_s")]
    dug, hauled = ([f"{kind}_{part}_s" for part in PARTS[kind]] for kind in ("dig", "haul"))
    writer = csv.writer(out)
    writer.writerow([by, *names, *dug, *hauled])
    for key, one in groups.items():
        facts = as_dict(one)
        parts = [one.parts.get(part, 0.0) for part in PARTS["dig"]]
        ways = [one.haul_parts.get(part, 0.0) for part in PARTS["haul"]]
        writer.writerow([key, *(facts[name] for name in names), *parts, *ways])
    return out.getvalue()


def _table(by: str, groups: "dict[str, Sum]", total: "Sum") -> list[str]:
    head = (by.upper(), "CYCLES", "BANK m³", "LOOSE m³", "t", "FILL", "LOADS", "km", "BANK m³/h", "CYCLE s")
    rows = [head, *(_row(name, one) for name, one in groups.items()), _row(say("all"), total)]
    widths = [max(columns(row[at]) for row in rows) for at in range(len(head))]
    return [
        "  ".join(
            [padded(row[0], widths[0]), *(cell.rjust(width) for cell, width in zip(row[1:], widths[1:], strict=True))]
        )
        for row in rows
    ]


def _row(name: str, one: "Sum") -> tuple[str, ...]:
    return (
        name, str(one.cycles), f"{one.bank:.2f}", f"{one.loose:.2f}", f"{one.mass / 1000:.2f}", _or_dash(one.fill, 2),
        str(one.loads), f"{one.distance / 1000:.2f}", _or_dash(one.rate, 1), _or_dash(one.mean_cycle, 1),
    )  # fmt: skip


def _or_dash(value: float | None, digits: int) -> str:
    return "-" if value is None else f"{value:.{digits}f}"
