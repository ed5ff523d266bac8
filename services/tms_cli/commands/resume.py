"""`tms resume`: go on with an interrupted run; leaves that have ended are not repeated."""

from typing import TYPE_CHECKING

import click

from tms_cli import live, session
from tms_cli.commands.run import Runner, report
from tms_cli.commands.runs import interrupted
from tms_cli.words import say
from tms_schedulers import asking
from tms_schedulers.names import Scheduler

if TYPE_CHECKING:
    from tms_msg_ts.srv import ResumePlan

    from tms_ros.node import Ros

SHOWN = 3  # leaves that are named among those that are not repeated


def plan(node: "Ros", run_id: str) -> "tuple[Scheduler, ResumePlan.Response]":
    """The scheduler that has an interrupted run, and its plan of resuming it.

    Raises:
        TmsError: NO_RUN.
    """
    from tms_msg_ts.srv import ResumePlan

    def ask(one: Scheduler) -> "tuple[Scheduler, ResumePlan.Response]":
        return one, session.call(node, ResumePlan, one.named("resume_plan"), run_id=run_id)

    return asking.of_any(session.site(), ask, "NO_RUN")


def _say(text: str) -> None:
    click.echo(text, err=True)


def _explain(found: "ResumePlan.Response") -> None:
    _say(say("{count} leaves have ended and are not repeated", count=len(found.done)) + (":" if found.done else ""))
    if len(found.done) > SHOWN:
        _say("  ...")
    for text in found.done[-SHOWN:]:
        _say(f"  {text}")
    if found.next:
        _say(say("these were at work when the scheduler was lost, and begin again first:"))
        for text in found.next:
            _say(f"  {text}")
    else:
        _say(say("no leaf was at work: it goes on with the next one"))
    _say(say("flags and blackboard values are worked out anew from the tree's first node"))


@click.command()
@click.argument("run")
@click.option("--yes", is_flag=True, help="Do not ask.")
@click.option("--wait", is_flag=True, help="Show the progress until the run has ended; Ctrl-C cancels it.")
@session.json_option
@click.pass_context
def command(ctx: click.Context, run: str, yes: bool, wait: bool, as_json: bool) -> None:
    """Resume an interrupted run: says what it will do first, and asks.

    RUN is its id, the beginning of it, or `last` for the newest interrupted run. Machines that were stopped have to be
    re-armed before.

    \b
    Example:
      tms resume last --wait
    """
    with session.ros() as node:
        run = interrupted(node, run)
        scheduler, found = plan(node, run)
        _say(say("run {run}, task {task}", run=run, task=found.task_id))
        _explain(found)
        if not yes:
            click.confirm(say("Resume it now?"), abort=True, err=True)
        runner = Runner(node, found.task_id, ignore_warnings=True, resume=run, scheduler=scheduler)
        end = runner.finish(live.display(as_json)) if wait else runner.begin()
    report(end, as_json)
    ctx.exit(end.exit_code)
