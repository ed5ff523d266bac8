"""`tms check`: check the site's configuration."""

import click

from tms_areas.trackers import trackers_flaw
from tms_cli import area_sets, session
from tms_cli.words import say
from tms_config.config import load_site
from tms_config.processes import table
from tms_config.yaml_file import located
from tms_ground.settings import ground_of, soils_of
from tms_hardware.settings import hardware_of
from tms_machine.sensing import load_sensing, sensing_path
from tms_reason.errors import ConfigError
from tms_ur.address import certificate, users


@click.command()
@click.option("--site", "chosen", metavar="NAME|FILE", help="Site to check (default: the one in use).")
@session.json_option
def command(chosen: str | None, as_json: bool) -> None:
    """Check the configuration; nothing is started.

    \b
    Examples:
      tms check
      tms check --site configs/sites/yard.yaml
    """
    site = load_site(chosen) if chosen else session.site()
    rows = table(site)
    if any(row.name == "ur" and row.pc in ("", site.pc) for row in rows):  # other PCs do not have the console's files
        certificate(site)
        users(site)
    for machine in site.file.machines:
        hardware_of(site, machine)
    if (ground := ground_of(site)) is not None:
        soils_of(site, ground)
    unmanned = [one.id for one in area_sets.configured(site).of("unmanned")] if site.area_files else []
    sensing = load_sensing(site)
    if (flaw := trackers_flaw(sensing.trackers, unmanned)) is not None:
        raise ConfigError(located(sensing_path(site), flaw, "trackers"))
    inputs = sensing.inputs
    if as_json:
        session.show_json(
            {
                "site": site.name, "file": str(site.path), "processes": [row.full for row in rows],
                "inputs": list(inputs),
            }
        )  # fmt: skip
        return
    click.echo(
        say(
            "{file}: right ({machines} machines, {processes} processes, {inputs} sensing inputs)",
            file=site.path,
            machines=len(site.file.machines),
            processes=len(rows),
            inputs=len(inputs),
        )
    )
