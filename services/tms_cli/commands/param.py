"""`tms param`: parameter records in the database."""

from pathlib import Path
from typing import Any

import click
import yaml

from tms_cli import live, session
from tms_cli.record_words import key_argument, parse_fields
from tms_cli.stored_records import age, as_dict, kind, load_file, records, summary, text, title, write
from tms_cli.words import Group, say
from tms_reason.units import unit

TYPES = click.Choice(["static", "dynamic"])
WHATEVER_AGE = -1.0


@click.group(cls=Group)
def command() -> None:
    """Show and change parameter records.

    A record is written MODEL/RECORD; one that all machines share is written /RECORD.

    \b
    Examples:
      tms param list zx200
      tms param set zx200/release_angle target_angle=-0.3
      tms param load configs/parameters/zx200.yaml
    """


@command.command()
@key_argument
@session.json_option
def get(key: tuple[str, str], as_json: bool) -> None:
    """Show a record: its fields, type, age and source.

    \b
    Example:
      tms param get zx200/target_excavate_pose
    """
    from tms_msg_db.srv import GetParameter

    with session.ros() as node:
        call = session.call(node, GetParameter, "/tms/db/get_parameter", model_name=key[0], record_name=key[1],
                            max_age=WHATEVER_AGE)  # fmt: skip
    if as_json:
        session.show_json(as_dict(call.record))
        return
    record = as_dict(call.record)
    limit = say(" (at most {seconds:g} s)", seconds=record["max_age"]) if record["max_age"] else ""
    from_ = record["source"] or say("unknown")
    click.echo(
        say("{record}: {type}, {age}, from {source}", record=title(call.record), type=record["type"],
            age=age(call.record) + limit, source=from_)
    )  # fmt: skip
    if record["description"]:
        click.echo(record["description"])
    for name, value in record["values"].items():
        click.echo(f"  {name:<22} {f'{text(value)} {unit(name)}':<24} {kind(value)}")


@command.command("set")
@key_argument
@click.argument("fields", nargs=-1, metavar="[FIELD=VALUE]...")
@click.option("--create", is_flag=True, help="Make the record if it is missing.")
@click.option("--type", "type_", type=TYPES, help="static: fixed during a run; dynamic: sensing may change it.")
@click.option("--description", default="", help="One line for people.")
@click.option("--max-age", type=click.FloatRange(min=0), help="Seconds that its values may be old; 0: no limit.")
@click.option("--expect", multiple=True, metavar="FIELD=VALUE", help="Change nothing unless the field holds this.")
@click.option("--remove", multiple=True, metavar="FIELD", help="Take a field away (may be repeated).")
@session.json_option
def set_(
    key: tuple[str, str],
    fields: tuple[str, ...],
    create: bool,
    type_: str | None,
    description: str,
    max_age: float | None,
    expect: tuple[str, ...],
    remove: tuple[str, ...],
    as_json: bool,
) -> None:
    """Change fields of a record in one step; the other fields stay.

    Values keep their type: 3 is an integer, 3.0 and 1e3 are decimals, true/false, [1.0, 2.0] is an array,
    anything else is text ("'5'" is text too).

    \b
    Examples:
      tms param set zx200/release_angle target_angle=-0.3
      tms param set /SHARED_FLG value=false --create --type dynamic
      tms param set /ROAD_SECTION TAKEN=true --expect TAKEN=false
      tms param set zx200/target_excavate_pose --max-age 5
      tms param set zx200/initial_pose --remove old_field
    """
    if not (fields or remove or type_ or description or max_age is not None):
        raise click.UsageError("nothing to change: give field=value, --remove, --type, --max-age or --description")
    expected = parse_fields(f"record {'/'.join(key)}", expect)
    limit = 0.0 if max_age is None else max_age or -1.0  # in the message 0 means: unchanged
    values = parse_fields(f"record {'/'.join(key)}", fields)
    with session.ros() as node:
        created = write(
            node, key, values, expected, create=create, type=type_ or "", description=description, max_age=limit,
            remove=list(remove),
        )  # fmt: skip
    if as_json:
        session.show_json({"model_name": key[0], "record_name": key[1], "created": created, "values": values})
    else:
        name = "/".join(key)
        click.echo(say("{record} created", record=name) if created else say("{record} changed", record=name))


@command.command()
@click.argument("file", type=click.Path(path_type=Path))
@session.json_option
def load(file: Path, as_json: bool) -> None:
    """Make or change all records of a file (a YAML list, see configs/parameters/zx200.yaml).

    The whole file is checked before anything is written. Records that say the same already are left alone, and so
    are fields that the file does not name.

    \b
    Example:
      tms param load configs/parameters/zx200.yaml
    """
    with session.ros() as node:
        done = load_file(node, file)
    if as_json:
        session.show_json(done)
    else:
        click.echo(summary(done))


@command.command("list")
@click.argument("model", required=False, default="")
@session.json_option
def list_(model: str, as_json: bool) -> None:
    """List the records of one model, or all.

    \b
    Example:
      tms param list zx200
    """
    with session.ros() as node:
        found = records(node, model)
    if as_json:
        session.show_json([as_dict(record) for record in found])
        return
    click.echo(f"{'RECORD':<40} {'TYPE':<8} {'AGE':>10}  {'SOURCE':<14} FIELDS")
    for record in found:
        names = ", ".join(value.name for value in record.values)
        click.echo(f"{title(record):<40} {record.type:<8} {age(record):>10}  {record.source:<14} {names}")
    if not found:
        click.echo(say("none: `tms param load FILE` or `tms param set MODEL/RECORD --create` makes records"), err=True)


@command.command()
@key_argument
@session.json_option
def rm(key: tuple[str, str], as_json: bool) -> None:
    """Remove a record."""
    from tms_msg_db.srv import RemoveParameter

    with session.ros() as node:
        session.call(node, RemoveParameter, "/tms/db/remove_parameter", model_name=key[0], record_name=key[1])
    if as_json:
        session.show_json({"removed": "/".join(key)})
    else:
        click.echo(say("{record} removed", record="/".join(key)))


@command.command()
@click.argument("model", required=False, default="")
@session.json_option
def export(model: str, as_json: bool) -> None:
    """Print records in the form that `tms param load` reads.

    \b
    Example:
      tms param export zx200 > zx200.yaml
    """
    with session.ros() as node:
        found = [as_dict(record) for record in records(node, model)]
    heads = ("model_name", "record_name", "type", "description", "max_age")
    flat = [{**{name: record[name] for name in heads if record[name] is not None}, **record["values"]}
            for record in found]  # fmt: skip
    if as_json:
        session.show_json(flat)
    else:
        click.echo(yaml.safe_dump(flat, sort_keys=False, allow_unicode=True), nl=False)


@command.command()
@key_argument
@click.option("--limit", type=click.IntRange(1), default=20, show_default=True, help="Newest changes to show.")
@session.json_option
def history(key: tuple[str, str], limit: int, as_json: bool) -> None:
    """Show the last changes of a record with their time and source.

    What sensing changes within two seconds counts as one change.

    \b
    Example:
      tms param history zx200/target_excavate_pose
    """
    from tms_msg_db.srv import ListParameterHistory

    from tms_machine.values import from_parameters

    with session.ros() as node:
        found = session.call(
            node, ListParameterHistory, "/tms/db/list_parameter_history", model_name=key[0], record_name=key[1],
            limit=limit,
        ).changes  # fmt: skip
    rows: list[dict[str, Any]] = [
        {"at": live.iso(one.stamp), "source": one.source, "values": from_parameters(one.values)} for one in found
    ]
    if as_json:
        session.show_json(rows)
        return
    for one, row in zip(found, rows, strict=True):
        fields = ", ".join(f"{name}={text(value)}" for name, value in row["values"].items())
        click.echo(f"{live.clock_time(one.stamp)}  {row['source'] or say('unknown'):<20} {fields}")
    if not rows:
        click.echo(say("no changes since the database module keeps them"), err=True)
