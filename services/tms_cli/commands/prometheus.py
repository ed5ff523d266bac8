"""`tms prometheus`: write the folder that Prometheus reads."""

from pathlib import Path

import click

from tms_cli import monitoring, session


@click.command()
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    metavar="FOLDER",
    help="Default: TMS_PROMETHEUS, or in the state folder.",
)
@click.option("--alertmanager", metavar="HOST:PORT", envvar="TMS_ALERTS_TO", help="Where alerts go.")
@session.json_option
def command(output: Path | None, alertmanager: str | None, as_json: bool) -> None:
    """Write Prometheus' configuration, rules and the targets of every process of the site.

    `tms up` does the same; a running Prometheus notices changed targets by itself.

    \b
    Examples:
      tms prometheus
      tms prometheus -o /etc/prometheus/tms --alertmanager 127.0.0.1:9093
    """
    site = session.site()
    folder = output.resolve() if output else monitoring.folder(site)
    monitoring.render(site, folder, alertmanager)
    if as_json:
        session.show_json({"folder": str(folder), "targets": monitoring.targets(site)})
    else:
        click.echo(f"start it with: prometheus --config.file={folder}/prometheus.yml "
                   f"--storage.tsdb.path={folder}/data --web.listen-address=127.0.0.1:9090")  # fmt: skip
