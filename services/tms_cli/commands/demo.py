"""`tms demo`: start a mesh in which a simulated excavator loads a truck, which hauls and tips the soil."""

import math
import shutil
from typing import TYPE_CHECKING

import click

from tms_cli import live, mesh, session, stored_records, task_file
from tms_cli.commands import rearm, run, task, template, up
from tms_cli.words import say
from tms_config.config import CONFIGS, Site
from tms_config.processes import find
from tms_reason.errors import TmsError
from tms_runtime import metrics
from tms_ur import address

if TYPE_CHECKING:
    from tms_ros.node import Ros

PARAMETERS = [CONFIGS / "parameters" / f"{name}.yaml" for name in ("zx200", "ic120", "shared")]
TASK = CONFIGS / "tasks" / "dig_load_and_haul.xml"
TEMPLATES = CONFIGS / "templates"
MASS_ERROR = "tms_ground_mass_error_kilograms"


@click.command()
@session.json_option
@click.pass_context
def command(ctx: click.Context, as_json: bool) -> None:
    """Start the mesh, store the records, the task and the templates, run the task, and show how.

    A zx200 digs two buckets into an ic120, which hauls and tips them.

    The mesh is left running; exit code 0 only if the task succeeded. May be repeated.

    \b
    Example:
      tms demo
    """
    site = session.site()
    started = mesh.up(site)
    _say(up.mesh_line(site, started))
    mesh.wait_ready(site, lambda line: _say(f"  {line}"))
    with session.ros() as node:
        _arm(node, site)
        for file in PARAMETERS:
            done = stored_records.summary(stored_records.load_file(node, file))
            _say(f"{file.stem}: " + say("records: {done}", done=done))
        _store_templates(node)
        stored = task.store(node, str(TASK), "Two buckets into a truck, which hauls them")
        _say(task.stored_line(stored))
        if site.file.backend == "sim":
            _say(say("the stand-ins live {factor:g} times as fast as machines do", factor=site.file.sim.speed))
        runner = run.Runner(node, stored.task_id, ignore_warnings=False)
        end = runner.finish(live.display(as_json))
        _sum_up(site, runner.view, end)
    run.report(end, as_json)
    _say(say("console and API: {url}", url=address.url(site.file)))
    if shutil.which("tms") is None:
        _say(say("`. .venv/bin/activate` puts the command tms on the path"))
    _say(say("the mesh goes on running: `make status` looks at it, `make down` ends it"))
    ctx.exit(end.exit_code)


def _sum_up(site: Site, view: live.View, end: run.End) -> None:
    """What was dug, loaded and tipped."""
    carried = view.loads.of.values() if view.loads is not None else ()
    vessels = [one for one in carried if not one.bucket]
    if not vessels:
        return
    cycles = sum(one.emptied for one in carried if one.bucket)
    bank, loaded = (math.fsum(getattr(one, name) for one in vessels) for name in ("in_bank", "in_loose"))
    tipped = math.fsum(one.out_loose for one in vessels)
    _say(say("cycles of the excavator: {count}", count=cycles))
    _say(say("loaded: {bank:.2f} m³ as it lay, {loose:.2f} m³ loose", bank=bank, loose=loaded))
    _say(say("tipped: {loose:.2f} m³ loose", loose=tipped))
    if (error := _mass_error(site)) is not None:
        _say(say("mass made or lost: {error:.1e} kg", error=error))
    factor = site.file.sim.speed if site.file.backend == "sim" else 1.0
    _say(say("duration: {seconds:.0f} s, {machine:.0f} s of the machines", seconds=end.seconds,
             machine=end.seconds * factor))  # fmt: skip


def _mass_error(site: Site) -> float | None:
    """What tms:ground has made or lost since its start [kg]; None if it does not tell."""
    from prometheus_client.parser import text_string_to_metric_families

    _, page = metrics.page(find(site, "tms:ground"))
    found = [one for one in text_string_to_metric_families(page) if one.name == MASS_ERROR]
    return float(found[0].samples[0].value) if found else None


def _store_templates(node: "Ros") -> None:
    for file in task_file.xml_files(TEMPLATES):
        try:
            _say(template.stored_line(file.stem, template.store(node, file)))
        except TmsError as error:
            if error.code != "TEMPLATE_EXISTS":  # somebody has stored a better one
                raise


def _arm(node: "Ros", site: Site) -> None:
    """Arm a stand-in of a new clone: no person can be near it. A machine that was stopped stays stopped."""
    from tms_msg_rc.msg import MachineState

    for machine in site.file.machines if site.file.backend == "sim" else ():
        if not rearm.never_armed(session.latched(node, MachineState, f"/{machine}/rc/state")):
            continue
        rearm.ask(node, machine, rearm.ask(node, machine).token)
        _say(say("{machine} is a stand-in and was never armed on this PC: armed now", machine=machine))


def _say(text: str) -> None:
    click.echo(text, err=True)
