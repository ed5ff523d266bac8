"""`tms demo`: start a mesh in which a simulated excavator does one loading cycle."""

import shutil
from typing import TYPE_CHECKING

import click

from tms_cli import live, mesh, session, stored_records, task_file
from tms_cli.commands import rearm, run, task, template, up
from tms_cli.words import say
from tms_config.config import CONFIGS, Site
from tms_reason.errors import TmsError
from tms_ur import address

if TYPE_CHECKING:
    from tms_ros.node import Ros

PARAMETERS = CONFIGS / "parameters" / "zx200.yaml"
TASK = CONFIGS / "tasks" / "one_loading_cycle.xml"
TEMPLATES = CONFIGS / "templates"


@click.command()
@session.json_option
@click.pass_context
def command(ctx: click.Context, as_json: bool) -> None:
    """Start the mesh, store the records and the sample task of the zx200 and the templates, run it, and show how.

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
        _say(say("records: {done}", done=stored_records.summary(stored_records.load_file(node, PARAMETERS))))
        _store_templates(node)
        stored = task.store(node, str(TASK), "One loading cycle of the zx200")
        _say(task.stored_line(stored))
        end = run.Runner(node, stored.task_id, ignore_warnings=False).finish(live.display(as_json))
    run.report(end, as_json)
    _say(say("console and API: {url}", url=address.url(site.file)))
    if shutil.which("tms") is None:
        _say(say("`. .venv/bin/activate` puts the command tms on the path"))
    _say(say("the mesh goes on running: `make status` looks at it, `make down` ends it"))
    ctx.exit(end.exit_code)


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
