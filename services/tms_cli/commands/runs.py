"""`tms runs`: list runs, newest first."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, TypeVar

import click

from tms_cli import live, session, words
from tms_cli.reasons import ManyRuns, NoRunInterrupted, RunUnknown
from tms_cli.words import padded, say, state
from tms_config.clock import unix_time
from tms_reason.errors import TmsError

if TYPE_CHECKING:
    from tms_msg_db.msg import Run
    from tms_msg_ts.msg import RunState

    from tms_ros.node import Ros

    R = TypeVar("R", Run, RunState)

RECENT = 100
MAX_RUNS = 10_000  # runs that the database lists at most


def history(node: "Ros", limit: int) -> "list[Run]":
    """Runs as the database has them, newest first."""
    from tms_msg_db.srv import ListRuns

    return list(session.call(node, ListRuns, "/tms/db/list_runs", limit=limit).runs)


def recent(node: "Ros", run_id: str) -> "Run | None":
    """The present state of a run among the newest ones, None if it is not among them."""
    return next((run for run in history(node, RECENT) if run.run_id == run_id), None)


def has_ended(run: "Run") -> bool:
    """Whether a run of the history is over."""
    return live.moment(run.ended_at) is not None


def find_run(runs: "Sequence[R]", word: str) -> "R":
    """Find a run of the database or of the scheduler, newest first, by its id, the beginning of it, or `last`.

    Raises:
        TmsError: none or several fit.
    """
    if word == "last":
        hits = runs[:1]
    else:
        hits = [run for run in runs if run.run_id == word] or [run for run in runs if run.run_id.startswith(word)]
    if not hits:
        raise TmsError(RunUnknown(word), "RUN_MISSING")
    if len(hits) > 1:
        raise TmsError(ManyRuns(word, len(hits), tuple(run.run_id for run in hits[:4])), "RUN_AMBIGUOUS")
    return hits[0]


def interrupted(node: "Ros", word: str) -> str:
    """The id of the newest interrupted run where the word is `last`; else the word, which the schedulers look up.

    Raises:
        TmsError: NO_RUN, no run is interrupted; or the database gave no answer.
    """
    if word != "last":
        return word
    found = next((run for run in history(node, MAX_RUNS) if run.state == "interrupted"), None)
    if found is None:
        raise TmsError(NoRunInterrupted(), "NO_RUN")
    return found.run_id


def as_dict(run: "Run") -> dict[str, Any]:
    """A run for --json."""
    from tms_machine.values import from_parameters

    return {
        "run_id": run.run_id,
        "task_id": run.task_id,
        "description": run.description,
        "state": run.state,
        "reason": words.english(run.reason),
        "machines": list(run.machines),
        "started_at": live.iso(run.started_at),
        "ended_at": live.iso(run.ended_at),
        "seconds": round(_seconds(run), 3),
        "values": from_parameters(run.values),
    }


def _seconds(run: "Run") -> float:
    begun, ended = live.moment(run.started_at), live.moment(run.ended_at)
    if begun is None:
        return 0.0
    return (ended.timestamp() if ended else unix_time()) - begun.timestamp()


def line(run: "Run") -> str:
    """A run as one line of the table."""
    colour = live.OUTCOME_COLOURS.get(run.state, "red")
    word = click.style(padded(state(run.state), 16), fg=colour)
    note = f"  ({words.reason(run.reason)})" if run.reason else ""
    return (
        f"{run.run_id:<28} {run.task_id:>5}  {word} {live.clock_time(run.started_at)} "
        f"{live.duration(_seconds(run)):>9}  {run.description}{note}"
    )


@click.command()
@click.option("--limit", default=20, show_default=True, type=click.IntRange(1, MAX_RUNS), help="How many.")
@session.json_option
def command(limit: int, as_json: bool) -> None:
    """List runs of tasks, newest first.

    \b
    Examples:
      tms runs
      tms runs --limit 5 --json
    """
    with session.ros() as node:
        found = history(node, limit)
    if as_json:
        session.show_json([as_dict(run) for run in found])
        return
    click.echo(f"{'RUN':<28} {'TASK':>5}  {'STATE':<16} {'STARTED':<19} {'DURATION':>9}  DESCRIPTION")
    for run in found:
        click.echo(line(run))
    if not found:
        click.echo(say("nothing has run yet: `tms run ID --wait` runs a task of `tms task list`"), err=True)
