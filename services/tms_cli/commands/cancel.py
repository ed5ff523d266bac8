"""`tms cancel`: end a run and wait until its machines were measured to stand still."""

from typing import TYPE_CHECKING

import click

from tms_cli import session, words
from tms_cli.commands.runs import MAX_RUNS, as_dict, find_run, has_ended, history, recent
from tms_cli.reasons import NoRunActive, NotEndedYet, RunHasEnded
from tms_cli.words import say, state
from tms_config.clock import monotonic, sleep
from tms_reason.errors import TmsError

if TYPE_CHECKING:
    from tms_msg_db.msg import Run

    from tms_ros.node import Ros

END_LIMIT = 30.0  # s for the machines to stand still
CHECK_PERIOD = 0.2  # s


def _which(node: "Ros", word: str) -> str:
    """The id of the run; without the database the given word itself, since a cancel must not depend on the database."""
    try:
        runs = history(node, MAX_RUNS)
    except TmsError:
        if word == "last":
            raise
        return word
    active = [run for run in runs if not has_ended(run)]
    if word == "last" and not active:
        raise TmsError(NoRunActive(), "NO_RUN")
    run = find_run(active if word == "last" else runs, word)
    if has_ended(run):
        raise TmsError(RunHasEnded(run.run_id, run.state), "RUN_ENDED")
    return run.run_id


def _wait(node: "Ros", run_id: str) -> "Run":
    deadline = monotonic() + END_LIMIT
    while monotonic() < deadline:
        run = recent(node, run_id)
        if run is not None and has_ended(run):
            return run
        sleep(CHECK_PERIOD)
    raise TmsError(
        NotEndedYet(run_id, END_LIMIT),
        "STOP_UNCONFIRMED",
    )


@click.command()
@click.argument("run")
@session.json_option
@click.pass_context
def command(ctx: click.Context, run: str, as_json: bool) -> None:
    """Cancel a run and wait until its machines were seen to stand still.

    RUN is its id, the beginning of it, or `last` for the newest active run. Exit code 0 only when the stop is
    confirmed.

    \b
    Example:
      tms cancel last
    """
    from tms_msg_ts.srv import CancelRun

    with session.ros() as node:
        run_id = _which(node, run)
        session.call(node, CancelRun, "/tms/cancel_run", run_id=run_id)
        click.echo(say("run {run} is being cancelled", run=run_id), err=True)
        ended = _wait(node, run_id)
    if as_json:
        session.show_json(as_dict(ended))
    else:
        click.echo(
            say(
                "run {run}: {state}{reason}",
                run=run_id,
                state=state(ended.state),
                reason=f" ({words.reason(ended.reason)})" if ended.reason else "",
            )
        )
    ctx.exit(0 if ended.state == "cancelled" else 1)
