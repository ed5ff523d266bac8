"""`tms run`: run a stored task and show its progress."""

import queue
from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING

import click

from tms_cli import live, session, templates, words
from tms_cli.commands.runs import has_ended, recent
from tms_cli.loads import Loads
from tms_cli.reasons import SchedulerForgot, SchedulerQuiet
from tms_cli.words import say, state
from tms_config.clock import monotonic
from tms_reason import wire
from tms_reason.errors import TmsError
from tms_reason.reason import Reason
from tms_runtime.reasons import NotStored
from tms_schedulers import asking
from tms_schedulers.names import Scheduler, own
from tms_schedulers.reasons import OtherScheduler

if TYPE_CHECKING:
    from tms_msg_db.msg import Run
    from tms_msg_ts.msg import RunStates

    from tms_ros.node import Ros
    from tms_ts.bt import Templates

CHECK_PERIOD = 0.1  # s between checks
SILENT = 10.0  # s without a message of the scheduler, which publishes its runs twice a second
FORGOTTEN = 5.0  # s of lists without this run, after which another scheduler process must have begun it
INTERRUPTED = 130
BETWEEN = " · "  # machine, subtask and record of a goal


@dataclass(frozen=True)
class End:
    """How a run ended, or its state when the command does not wait for the end."""

    run_id: str
    outcome: str
    error_code: str
    error_msg: str
    seconds: float
    interrupted: bool = False

    @property
    def exit_code(self) -> int:
        if self.interrupted:
            return INTERRUPTED
        return 0 if self.outcome in ("success", "running", "stopping") else 1


class Runner:
    """Sends one task to the scheduler and follows it."""

    def __init__(
        self, node: "Ros", task_id: int, ignore_warnings: bool, resume: str = "", scheduler: Scheduler | None = None
    ) -> None:
        """`scheduler`: the one to which the run belongs; without it, the one that is asked first says which."""
        from tms_msg_ts.action import ExecuteTask

        from tms_schedulers.hearing import hear_runs

        self._node = node
        self._feedback: queue.SimpleQueue[ExecuteTask.Feedback] = queue.SimpleQueue()
        self._received_at = self._listed_at = monotonic()
        self._asked_again = False
        self._reported: Run | None = None  # the run in the history, for the case that its result never comes
        self.view = _view(node, task_id)
        self._goal = ExecuteTask.Goal(task_id=task_id, ignore_warnings=ignore_warnings, resume=resume)
        if scheduler is None:
            asking.of_first(session.site(), self._send)
        else:
            self._send(scheduler)
        hear_runs(node, session.site(), self._list_received)

    def _send(self, scheduler: Scheduler) -> None:
        from tms_msg_ts.action import ExecuteTask

        from tms_schedulers.sending import send

        self._peer = self._node.peer(ExecuteTask, scheduler.named("execute_task"))
        self._call = send(self._peer, self._goal, self._feedback.put)
        self._received_at = self._listed_at = monotonic()

    def begin(self) -> End:
        """Return when the run has begun or was refused. Ctrl-C cancels it."""
        return self._until(None, lambda: bool(self.view.run_id) and self.view.state != "preparing")

    def finish(self, display: live.Display) -> End:
        """Show the run until it has ended. Ctrl-C cancels it and goes on showing; a second one ends the command."""
        with display:
            end = self._until(display, lambda: False)
            display.show(self.view, self.view.close(end.outcome))
            return end

    def _until(self, display: live.Display | None, enough: Callable[[], bool]) -> End:
        interrupted = False
        try:
            self._follow(display, enough)
        except KeyboardInterrupt:
            interrupted = True
            self._cancel()
            self._follow(display, lambda: False)
        return self._end(interrupted)

    def _follow(self, display: live.Display | None, enough: Callable[[], bool]) -> None:
        while not (self._over() and self._feedback.empty()) and not enough():
            try:
                feedback = self._feedback.get(timeout=CHECK_PERIOD)
            except queue.Empty:
                self._look_after_scheduler()
                changed: list[live.NodeView] = []
            else:
                self._received_at = self._listed_at = monotonic()
                changed = self.view.received(feedback)
            if display is not None:
                display.show(self.view, changed)

    def _cancel(self) -> None:
        from tms_msg_ts.srv import CancelRun

        click.echo("\n" + say("cancelling; waiting until the machines stand still (Ctrl-C again leaves)"), err=True)
        if not self.view.run_id:
            self._peer.cancel(self._call)
            return
        try:
            where = session.site()
            session.of_any(self._node, where, CancelRun, "cancel_run", "NO_RUN", run_id=self.view.run_id)
        except TmsError as error:
            click.echo(
                say("tms: the cancel did not get through: {error}; trying the action itself", error=error), err=True
            )
            self._peer.cancel(self._call)

    def _list_received(self, message: "RunStates") -> None:
        """Take the list of the scheduler's active runs; called on ROS's thread."""
        now = monotonic()
        view = self.view
        if any(run.run_id == view.run_id if view.run_id else run.task_id == view.task_id for run in message.runs):
            self._listed_at = now
        self._received_at = now

    def _look_after_scheduler(self) -> None:
        """Detect the loss of the scheduler: a killed one never sends a result."""
        if monotonic() - self._received_at > SILENT:
            lost: Reason = SchedulerQuiet(SILENT, self.view.run_id)
        elif self._received_at - self._listed_at > FORGOTTEN / 2 and not self._asked_again:
            self._asked_again = True
            self._peer.ask_again(self._call)
            return
        elif self._received_at - self._listed_at > FORGOTTEN:
            self._reported = self._in_history()
            if self._reported is not None:
                return
            lost = SchedulerForgot(self.view.run_id)
        else:
            return
        raise TmsError(lost, "SCHEDULER_LOST")

    def _over(self) -> bool:
        result = self._call.result
        why = None if result is None or result.outcome != "refused" else wire.of(result.error_msg)
        if isinstance(why, OtherScheduler):
            self._send(own(session.site(), why.scheduler))
        return self._call.outcome is not None or self._reported is not None

    def _in_history(self) -> "Run | None":
        """The run in the history, if it has ended; else None."""
        try:
            run = recent(self._node, self.view.run_id)
        except TmsError:
            return None
        return run if run is not None and has_ended(run) else None

    def _end(self, interrupted: bool) -> End:
        from tms_ros.goals import Outcome

        result, view = self._call.result, self.view
        if self._call.outcome is None and self._reported is not None:
            code = "" if self._reported.state == "success" else "FAILED"
            return End(view.run_id, self._reported.state, code, self._reported.reason, view.elapsed, interrupted)
        if self._call.outcome is None:
            return End(view.run_id, view.state, "", "", view.elapsed, interrupted)
        if self._call.outcome in (Outcome.REJECTED, Outcome.LOST) or result is None:
            why = say("the scheduler did not take the task: see `tms logs tms:ts`")
            return End(view.run_id, "refused", self._call.outcome.name, why, view.elapsed, interrupted)
        run_id = result.run_id or view.run_id
        return End(run_id, result.outcome, result.error_code, result.error_msg, view.elapsed, interrupted)


def _view(node: "Ros", task_id: int) -> live.View:
    """Make the view of a run from the task's text: machines to watch and goals of the leaves."""
    from tms_msg_db.srv import GetTask
    from tms_msg_rc.msg import MachineState

    task = session.call(node, GetTask, "/tms/db/get_task", task_id=task_id).task
    goals = _goals(task.task_sequence, lambda name: templates.text_of(node, name))
    view = live.View(task_id, task.description, goals, loads=Loads(node, session.site()))
    named = {goal.partition(BETWEEN)[0] for _, goal in goals}  # also by templates
    for machine in session.site().file.machines:
        if machine in named or f'"{machine}"' in task.task_sequence:
            node.subscribe(MachineState, f"/{machine}/rc/state", view.machine_received, latched=True)
    return view


def _goals(text: str, stored: "Templates") -> list[tuple[str, str]]:
    """(node type, goal) of every node in document order; nothing for a tree that does not load here."""
    from tms_ts.bt import TreeError, load
    from tms_ts.bt.tree import SendsGoal

    try:
        nodes = load(text, templates=stored).nodes
    except TreeError:
        return []  # the scheduler refuses it and gives the reason
    return [(n.registration_name, BETWEEN.join(n.goal_asked()) if isinstance(n, SendsGoal) else "") for n in nodes]


def report(end: End, as_json: bool) -> None:
    """Print how the run ended and where to read more."""
    if as_json:
        shown = {key: value for key, value in asdict(end).items() if key != "interrupted"}
        session.show_json({**shown, "error_msg": words.english(end.error_msg)})
    elif end.outcome == "running":
        click.echo(say("run {run} has begun: `tms events {run} --follow` shows it", run=end.run_id))
        return
    else:
        word = click.style(state(end.outcome).upper(), fg=live.OUTCOME_COLOURS.get(end.outcome, "red"), bold=True)
        click.echo(
            say("{outcome} after {seconds:.1f} s, run {run}", outcome=word, seconds=end.seconds, run=end.run_id or "-")
        )
        if end.run_id:
            click.echo(say("history: tms events {run}", run=end.run_id))
    reason = wire.of(end.error_msg)
    if (
        end.outcome in ("success", "cancelled") and reason is not None and reason.find(NotStored) is not None
    ):  # other outcomes print their reason below
        note = say("the end of {run} is not stored yet: the disk of the scheduler's PC is slow or full", run=end.run_id)
        click.echo(f"tms: {note}", err=True)
    if end.exit_code:
        click.echo(f"tms: {_why(end)}", err=True)


def _why(end: End) -> str:
    """One line for a run that did not succeed."""
    if end.outcome == "cancelled":
        return say("run {run} was cancelled and its machines were seen to stand still", run=end.run_id)
    code = f" ({end.error_code})" if end.error_code else ""
    reason = words.with_advice(end.error_msg) or say("no reason given: see `tms logs tms:ts`")
    return f"{state(end.outcome)}{code}: {reason}"


@click.command()
@click.argument("task_id", type=click.IntRange(1), metavar="ID")
@click.option("--wait", is_flag=True, help="Show the progress until the task has ended; Ctrl-C cancels it.")
@click.option("--ignore-warnings", is_flag=True, help="Start although the check before the run warns.")
@session.json_option
@click.pass_context
def command(ctx: click.Context, task_id: int, wait: bool, ignore_warnings: bool, as_json: bool) -> None:
    """Run a stored task.

    Without --wait it returns as soon as the run has begun. Exit code 0: success (or begun), 1: refused or
    failed, 130: interrupted by Ctrl-C, which cancels the run and waits until the machines stand still.

    \b
    Examples:
      tms run 1 --wait
      tms run 1 --json
    """
    with session.ros() as node:
        runner = Runner(node, task_id, ignore_warnings)
        end = runner.finish(live.display(as_json)) if wait else runner.begin()
    report(end, as_json)
    ctx.exit(end.exit_code)
