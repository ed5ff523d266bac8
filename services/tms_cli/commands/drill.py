"""`tms drill`: stop simulated machines in every way, and compare each receipt with their true motion."""

import errno
import os
import random
import shutil
import signal
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import click

from tms_cli import mesh, session
from tms_cli.drill import figures as drill_figures
from tms_cli.drill.plan import OPERASIM, STAND_INS, STOPS, Trial, plan, plan_only
from tms_cli.drill.report import markdown, text
from tms_cli.drill.stand_ins import GROUP, StandIns
from tms_cli.drill.verdict import Row
from tms_cli.reasons import DrillRuns, NotForDrill, NotWritable
from tms_config.config import Site
from tms_config.processes import table
from tms_host.supervisor import Supervisor
from tms_reason.errors import ConfigError, TmsError

FOLDER = "drill"  # in the state folder of the site, new for each drill


def check(site: Site) -> None:
    """Check that the site may be drilled.

    Raises:
        ConfigError: the site is no simulation on one PC, or has no machine.
    """
    simulated = any(row.group == GROUP for row in table(site))
    if not simulated or site.file.pcs or not site.file.machines:
        raise ConfigError(NotForDrill(str(site.path)))


def own_state(site: Site) -> None:
    """Choose a new state folder for the drill's processes: their machines were never armed, the history is empty.

    Raises:
        TmsError: another drill of this site uses it.
    """
    folder = site.state / FOLDER
    if Supervisor(replace(site, state=folder)).alive():
        raise TmsError(DrillRuns(site.name))
    shutil.rmtree(folder, ignore_errors=True)
    os.environ["TMS_STATE"] = str(folder)


def planned(site: Site, seed: int, rounds: int, quick: bool, only: str | None = None) -> list[list[Trial]]:
    """The trials for this site, in waves."""
    planners = {name: site.model_of(name).planner is not None for name in site.file.machines}
    kinds = STAND_INS if site.file.backend == "sim" else OPERASIM
    if only is None:
        return plan(seed, planners, rounds, quick, kinds)
    if only not in kinds.stops:
        raise click.UsageError(f"this site cannot be drilled with {only!r}: {', '.join(kinds.stops)}")
    return plan_only(seed, planners, only, rounds, kinds)


def drill(site: Site, waves: list[list[Trial]]) -> list[Row]:
    """Start the mesh, make the trials, and end all processes."""
    from tms_cli.drill.waves import Waves

    signal.signal(signal.SIGTERM, lambda _number, _frame: sys.exit(128 + signal.SIGTERM))
    mesh.up(site, without=GROUP)
    try:
        with StandIns(site) as stand_ins:
            mesh.wait_ready(site, lambda _: None)
            with session.ros() as node:
                trials = Waves(node, site, stand_ins)
                try:
                    trials.warm_up()
                    return trials.go(waves)
                finally:
                    trials.close()
    finally:
        mesh.down(site)


@click.command()
@click.option("--quick", is_flag=True, help="Every kind of stop and every fault at least once, in about 6 minutes.")
@click.option("--rounds", default=1, show_default=True, type=click.IntRange(1, 50), help="About 160 trials each.")
@click.option(
    "--only", metavar="STOP", type=click.Choice(sorted(STOPS)), help="One kind of stop: a round is one trial a machine."
)
@click.option("--seed", type=int, help="Repeat the plan of an earlier drill; it is printed with the figures.")
@click.option("--report", type=click.Path(dir_okay=False, path_type=Path), help="Write a page (Markdown).")
@session.json_option
@click.pass_context
def command(
    ctx: click.Context, quick: bool, rounds: int, only: str | None, seed: int | None, report: Path | None, as_json: bool
) -> None:
    """Stop every simulated machine in every way, with every fault, and compare each receipt with the true motion.

    Runs are cancelled, machines stopped, processes killed and frozen, and the power is cut, while machines lie, coast
    or disobey. Starts a mesh of its own and ends it. Exit code 0 only without a false receipt, a motion that went on
    for too long, a stop that is neither confirmed nor latched, a run left hanging, a process that did not come back,
    and a trial left out.

    \b
    Examples:
      tms --site drill drill --quick
      tms --site drill drill --json --report drill.md
      tms --site drill drill --rounds 4 --seed 7
      tms --site drill drill --only "kill rc+tms:ts+rp+subtask" --rounds 9
      tms --site drill-physx drill --quick
    """
    if report is not None and not os.access(report.absolute().parent, os.W_OK):  # before an hour of work
        raise TmsError(NotWritable(str(report), os.strerror(errno.EACCES)), "NO_FILE")
    if quick and only:
        raise click.UsageError("--quick and --only exclude each other: --quick tries every kind of stop")
    check(session.site())
    own_state(session.site())
    site = session.site()  # with the state folder of the drill
    chosen = random.SystemRandom().randrange(10**6) if seed is None else seed
    waves = planned(site, chosen, rounds, quick, only)
    click.echo(f"seed {chosen}, {sum(map(len, waves))} trials, logs in {site.state}/log", err=True)
    rows = drill(site, waves)
    figures = drill_figures.summary(rows, chosen)
    _report(figures, rows, site, report, as_json)
    ctx.exit(1 if any(figures[bad] for bad in drill_figures.BAD) else 0)


def _report(figures: dict[str, Any], rows: list[Row], site: Site, report: Path | None, as_json: bool) -> None:
    if as_json:
        session.show_json(figures)
    else:
        click.echo(text(figures, rows))
    if report is not None:
        report.write_text(markdown(rows, figures, site.name), encoding="utf-8")
