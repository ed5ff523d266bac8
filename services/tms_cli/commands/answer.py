"""`tms answer`: show the questions of runs to the operator (WaitForClick), or answer one."""

import getpass
import socket
from typing import TYPE_CHECKING, Any

import click

from tms_cli import live, session
from tms_cli.reasons import ManyQuestions, NobodyAsks, NobodyAsksThis, SchedulerSilent
from tms_cli.words import say
from tms_reason.errors import RosError, TmsError

if TYPE_CHECKING:
    from tms_msg_ts.msg import Question

    from tms_ros.node import Ros


@click.command()
@click.argument("reply", required=False, type=click.Choice(["yes", "no"]))
@click.option("--question", metavar="ID", help="Which one, when several are open; the beginning is enough.")
@session.json_option
def command(reply: str | None, question: str | None, as_json: bool) -> None:
    """Show what runs ask (WaitForClick nodes), or answer it. The first answer counts, wherever it is given.

    \b
    Examples:
      tms answer
      tms answer yes
      tms answer no --question 20261121-104918-7419-1795258158
    """
    from tms_msg_ts.srv import AnswerQuestion

    with session.ros() as node:
        asked = [one for one in open_questions(node) if question is None or one.id.startswith(question)]
        if reply is not None:
            one = _only(asked, question)
            by = f"{getpass.getuser()} at {socket.gethostname()}"
            answer = {"id": one.id, "yes": reply == "yes", "by": by}
            session.of_any(node, session.site(), AnswerQuestion, "answer", "NO_QUESTION", **answer)
    if as_json:
        session.show_json([_as_dict(one) for one in asked])
    elif reply is not None:
        click.echo(say("answered {reply}: {text}", reply=reply, text=asked[0].text or asked[0].title))
    else:
        for one in asked:
            until = say(", until {time}", time=live.clock_time(one.until)) if one.until.sec else ""
            click.echo(f"{one.id}  {one.title}: {one.text}{until}")
        if not asked:
            click.echo(say("there are no open questions"), err=True)


def open_questions(node: "Ros") -> "list[Question]":
    """Questions as the scheduler lists them.

    Raises:
        RosError: the scheduler does not publish them.
    """
    received = session.runs(node)
    if received is None:
        raise RosError(SchedulerSilent(), "NO_ANSWER")
    return list(received.questions)


def _only(asked: "list[Question]", question: str | None) -> "Question":
    if len(asked) == 1:
        return asked[0]
    if not asked:
        raise TmsError(NobodyAsks() if question is None else NobodyAsksThis(question), "NO_QUESTION")
    raise TmsError(ManyQuestions(len(asked), tuple(one.id for one in asked)), "AMBIGUOUS")


def _as_dict(one: "Question") -> dict[str, Any]:
    return {
        "id": one.id, "run_id": one.run_id, "node": one.node, "title": one.title, "text": one.text,
        "asked_at": live.iso(one.asked_at), "until": live.iso(one.until) if one.until.sec else None,
    }  # fmt: skip
