"""`tms cancel`: end a run and wait until its machines were measured to stand still."""

from typing import TYPE_CHECKING

import click

from tms_cli import session, words
from tms_cli.commands.runs import MAX_RUNS, as_dict, find_run, has_ended, history, recent
from tms_cli.reasons import NoRunActive, NotEndedYet, RunHasEnded, SchedulerSilent
from tms_cli.words import say, state
from tms_config.clock import monotonic, sleep
from tms_reason.errors import RosError, TmsError

if TYPE_CHECKING:
    from tms_msg_db.msg import Run

    from tms_ros.node import Ros

END_LIMIT = 30.0  # s for the machines to stand still
CHECK_PERIOD = 0.2  # s


def _which(node: "Ros", word: str) -> str:
    """The id of the run, from the scheduler: a cancel must not wait for the database, which knows of ended ones."""
    from tms_machine import stamps

    told = session.runs(node, session.CALL_LIMIT, word)
    active = [] if told is None else sorted(told.runs, key=lambda run: stamps.seconds(run.started_at), reverse=True)
    if word == "last" and not active:
        raise RosError(SchedulerSilent(), "NO_ANSWER") if told is None else TmsError(NoRunActive(), "NO_RUN")
    if word == "last" or any(run.run_id.startswith(word) for run in active):
        return find_run(active, word).run_id
    return _not_active(node, word)


def _not_active(node: "Ros", word: str) -> str:
    """The given word itself where the database is away: the scheduler then says what it knows."""
    try:
        runs = history(node, MAX_RUNS)
    except TmsError:  # also one that answers that its store is away
        return word
    run = find_run(runs, word)
    if has_ended(run):
        raise TmsError(RunHasEnded(run.run_id, run.state), "RUN_ENDED")
    return run.run_id


def _wait(node: "Ros", run_id: str) -> "Run":
    """The ended run, as the database has it; one that gives no answer for a while is asked again."""
    deadline, trouble = monotonic() + END_LIMIT, None
    while monotonic() < deadline:
        try:
            run, trouble = recent(node, run_id), None
        except TmsError as error:
            run, trouble = None, error
        if run is not None and has_ended(run):
            return run
        sleep(CHECK_PERIOD)
    raise trouble or TmsError(NotEndedYet(run_id, END_LIMIT), "STOP_UNCONFIRMED")


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
        session.of_any(node, session.site(), CancelRun, "cancel_run", "NO_RUN", run_id=run_id)
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
