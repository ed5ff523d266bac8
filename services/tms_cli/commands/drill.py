"""`tms drill`: kill processes of a simulated site while the machine moves, and tell whether it stopped."""

import os
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tms_cli import mesh, session, stored_records
from tms_cli.commands import task
from tms_cli.drill.rows import Case, Row, cases, summary
from tms_core.config import CONFIGS, Site
from tms_core.errors import ConfigError, TmsError
from tms_core.processes import table

if TYPE_CHECKING:
    from tms_core.ros import Ros
    from tms_ts.bt.tree import LeafGoal

PARAMETERS = CONFIGS / "parameters" / "zx200.yaml"
TASK = CONFIGS / "tasks" / "endless_loading_cycles.xml"
MACHINE = "zx200"
BAD = ("unconfirmed", "hung", "not_back", "left_out")  # figures that must be 0
QUICK_LIMIT, LIMIT = 540.0, 3600.0  # s, the latter a round


def leaves() -> "list[LeafGoal]":
    """What the leaves of the task ask for, in order."""
    from tms_ts import bt

    return bt.load(TASK.read_text(encoding="utf-8")).leaf_goals()


def plan(site: Site, quick: bool) -> list[Case]:
    """All cases for a site.

    Raises:
        ConfigError: it is no simulation, or lacks the machine of the sample task.
    """
    if site.file.backend != "sim":
        raise ConfigError(f"{site.path}: the drill kills processes on purpose: only for backend 'sim'")
    if MACHINE not in site.file.machines:
        raise ConfigError(f"{site.path}: the drill needs a machine '{MACHINE}' under machines:")
    subtasks = [f"{goal.machine}:{goal.subtask}" for goal in leaves()]
    movers = ["tms:ts", f"{MACHINE}:rp", f"{MACHINE}:rc"]
    others = [row.full for row in table(site) if row.group == "tms" and row.full != "tms:ts"]
    return cases(movers, subtasks, others, quick)


def drill(node: "Ros", site: Site, todo: list[Case], limit: float) -> list[Row]:
    """Run the cases until all are done or the time is over."""
    from tms_cli.drill.eyes import Eyes
    from tms_cli.drill.patrol import Patrol
    from tms_cli.drill.trial import Trial
    from tms_cli.drill.work import Work

    stored_records.load_file(node, PARAMETERS)
    stored = task.store(node, str(TASK), "Loading cycles of the zx200 without end, for the drill")
    paths = [goal.path for goal in leaves()]
    eyes, work = Eyes(node, site, MACHINE), Work(node, site, MACHINE, stored.task_id, paths)
    patrol = Patrol(MACHINE, paths, site.file.on_loss.retries, eyes, work, Trial(site, MACHINE, eyes, work))
    return patrol.walk(todo, limit)


@click.command()
@click.option("--quick", is_flag=True, help="At least 20 kills in at most 10 minutes.")
@click.option(
    "--rounds", default=1, show_default=True, type=click.IntRange(1, 50), help="Times that each case is tried."
)
@click.option("--report", type=click.Path(dir_okay=False, path_type=Path), help="Write a one-page report (Markdown).")
@session.json_option
@click.pass_context
def command(ctx: click.Context, quick: bool, rounds: int, report: Path | None, as_json: bool) -> None:
    """Kill every process while every leaf of the sample task moves the simulated zx200, and measure the stops.

    One endless run is disturbed again and again and must go on each time. Starts the mesh if it does not run, and ends
    it then. Exit code 0 only without an unconfirmed stop, a run left hanging, a process that did not come back, or a
    case left out.

    \b
    Examples:
      tms drill --quick
      tms drill --json --report drill.md
      tms drill --rounds 4
    """
    from tms_cli.drill.report import markdown

    if report is not None and not os.access(report.absolute().parent, os.W_OK):  # and not after an hour of work
        raise TmsError(f"{report}: its folder is not there or cannot be written: choose another place", "NO_FILE")
    site = session.site()
    todo = plan(site, quick) * rounds
    started = mesh.up(site)
    try:
        mesh.wait_ready(site, lambda text: None)
        with session.ros() as node:
            rows = drill(node, site, todo, QUICK_LIMIT if quick else LIMIT * rounds)
    finally:
        if started:
            mesh.down(site)
    figures = summary(rows)
    if as_json:
        session.show_json(figures)
    else:
        click.echo(
            f"{figures['kills']} kills, {figures['unconfirmed']} stops unconfirmed, {figures['hung']} runs hung, "
            f"{figures['not_back']} processes not back, "
            f"{figures['left_out']} cases left out, told to stop after at most {figures['kill_to_stop_max_s']} s, "
            f"stood within {figures['stop_p99_s']} s (p99)"
        )
    if report is not None:
        report.write_text(markdown(rows, figures, site.name), encoding="utf-8")
    ctx.exit(1 if any(figures[bad] for bad in BAD) else 0)
