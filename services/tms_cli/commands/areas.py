"""`tms areas`: where machines may be: check the site's areas, enable them, compare, import and export."""

import getpass
import json
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tms_cli import area_sets, new_file, session
from tms_cli.reasons import AreaFileThere
from tms_cli.words import Group, padded, say
from tms_reason.errors import TmsError
from tms_ur import gateway_areas

if TYPE_CHECKING:
    from tms_areas.changes import Change

FILE = click.Path(path_type=Path)


@click.group(cls=Group)
def command() -> None:
    """Where machines may be: areas of the site, in configs/sites/SITE/areas/*.geojson.

    A person enables them; then every gateway holds its machine in them. They are no protective device: people are
    kept safe by other means.

    \b
    Examples:
      tms areas check
      tms areas enable
      tms areas diff
    """


@command.command()
@session.json_option
def check(as_json: bool) -> None:
    """Check the files of the site's areas, and list what they hold.

    \b
    Examples:
      tms areas check
      tms --site yard areas check --json
    """
    found = area_sets.configured(session.site())
    if as_json:
        session.show_json({"id": found.id, "areas": [area_sets.as_dict(one) for one in found.areas]})
    else:
        click.echo("\n".join(area_sets.show(found)))


@command.command()
@session.json_option
def show(as_json: bool) -> None:
    """Show which areas are enabled, at each gateway.

    \b
    Examples:
      tms areas show
      tms areas show --json
    """
    wanted = area_sets.configured(session.site())
    with session.ros() as node:
        told = {machine: area_sets.enabled(node, machine) for machine in area_sets.machines()}
    if as_json:
        gateways = {
            machine: {"id": None if found is None else found.id, "by": who} for machine, (who, found) in told.items()
        }
        session.show_json({"configured": wanted.id, "gateways": gateways})
        return
    click.echo("\n".join(area_sets.show(wanted)))
    for machine, (who, found) in told.items():
        if found is None:
            click.echo(say("{machine}: no areas are enabled", machine=machine))
        elif found.id != wanted.id:
            click.echo(say("{machine}: another set is enabled: {id}, by {who}", machine=machine, id=found.id, who=who))
        else:
            click.echo(say("{machine}: enabled by {who}", machine=machine, who=who))


@command.command()
@click.option("--by", "who", default=getpass.getuser, help="Who enables them (default: your user name).")
@click.option("--yes", is_flag=True, help="Do not ask; for scripts that have shown them to a person.")
@session.json_option
def enable(who: str, yes: bool, as_json: bool) -> None:
    """Let the areas of the site's files count from now on, at every gateway.

    Shows what changes, and asks. Refused while a machine moves where the new areas would stop it, or while a gateway
    does not answer. Each gateway keeps the set on its disk, with who enabled it.

    \b
    Examples:
      tms areas enable
      tms areas enable --by "T. Yamada" --yes
    """
    from tms_areas.changes import changes

    wanted, machines = area_sets.configured(session.site()), area_sets.machines()
    with session.ros() as node:
        before = {machine: area_sets.enabled(node, machine)[1] for machine in machines}
        _tell({change for old in before.values() for change in changes(old, wanted)})
        if not yes:
            click.confirm(say("Enable these areas for all machines?"), abort=True, err=True)
        gateway_areas.enable(node, machines, wanted, who)
    click.echo(say("enabled: {id}", id=wanted.id[:12]), err=True)
    if as_json:
        session.show_json({"id": wanted.id, "by": who, "machines": machines})


@command.command()
@click.argument("machine", required=False)
@session.json_option
def diff(machine: str | None, as_json: bool) -> None:
    """Show how the areas of the site's files differ from the enabled ones (of one machine, or of the first).

    \b
    Examples:
      tms areas diff
      tms areas diff zx200 --json
    """
    from tms_areas.changes import changes

    wanted = area_sets.configured(session.site())
    chosen = session.machines((machine,), False)[0] if machine else area_sets.machines()[0]
    with session.ros() as node:
        found = changes(area_sets.enabled(node, chosen)[1], wanted)
    if as_json:
        session.show_json([vars(one) for one in found])
    else:
        _tell(set(found))


@command.command("import")
@click.argument("file", type=FILE)
@session.json_option
def import_(file: Path, as_json: bool) -> None:
    """Check a GeoJSON of areas and copy it to the site's areas, in `map`. They are not enabled by that.

    \b
    Examples:
      tms areas import drawn.geojson
    """
    from tms_areas.areas import AreaSet
    from tms_areas.geojson import gathered, written

    site = session.site()
    new = area_sets.of_file(site, file)
    target = site.area_folder / f"{file.stem}.geojson"
    if target.exists():
        raise TmsError(AreaFileThere(str(target)))
    whole = gathered([*(area_sets.of_file(site, path) for path in site.area_files), new])
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text(json.dumps(written(AreaSet(tuple(new))), ensure_ascii=False, indent=1) + "\n", encoding="utf-8")
    if as_json:
        session.show_json({"file": str(target), "id": whole.id})
    else:
        click.echo(f"{target}: {len(new)}")


@command.command()
@click.argument("file", type=FILE)
@click.option("--vda5050", is_flag=True, help="As a zoneSet of VDA 5050, version 3.0.0.")
@session.json_option
def export(file: Path, vda5050: bool, as_json: bool) -> None:
    """Write the areas of the site's files into FILE, which must not be there yet: as GeoJSON in `map`.

    \b
    Examples:
      tms areas export areas.geojson
      tms areas export zones.json --vda5050
    """
    from tms_areas.geojson import written
    from tms_areas.vda5050 import zone_set
    from tms_config.clock import utc_now

    site = session.site()
    found = area_sets.configured(site)
    now = utc_now().strftime("%Y-%m-%dT%H:%M:%S.%f")[:-3] + "Z"
    told = zone_set(found, site.name, now) if vda5050 else written(found)
    new_file.write(file, f"{json.dumps(told, ensure_ascii=False, indent=1)}\n".encode())
    if as_json:
        session.show_json({"file": str(file), "id": found.id})
    else:
        click.echo(f"{file}: {found.id[:12]}")


def _tell(found: "set[Change]") -> None:
    """Print what changes, for people."""
    for one in sorted(found, key=lambda one: (one.id, one.kind)):
        line = say("{before:.1f} m² -> {after:.1f} m², {away:.1f} m² less, {new:.1f} m² more", **vars(one))
        click.echo(f"{padded(one.id, 16)} {padded(area_sets.kind(one.kind), 10)} {line}", err=True)
    if not found:
        click.echo(say("nothing changes"), err=True)
