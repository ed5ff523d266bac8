"""`tms plan-check`: how an excavator would move for a record, without moving."""

from typing import TYPE_CHECKING, Any

import click

from tms_cli import session
from tms_cli.words import english, language, reason, say
from tms_reason import texts

if TYPE_CHECKING:
    from trajectory_msgs.msg import JointTrajectory

    from tms_cli.plan_check import Checked

ROWS = 12  # of a path that is shown


@click.command()
@click.argument("machine")
@click.argument("record")
@click.option("--subtask", default="", help="For which subtask (default: the one that the record is for).")
@session.json_option
@click.pass_context
def command(ctx: click.Context, machine: str, record: str, subtask: str, as_json: bool) -> None:
    """Plan the motion that a record asks of an excavator's arm, from where the arm is now; nothing moves.

    Shows which way it would go, how long it takes, how near it comes to what, and the path; or why it would be refused
    (exit code 1). Obstacles are where they are now.

    \b
    Examples:
      tms plan-check zx200 target_excavate_pose
      tms plan-check zx200 target_release_pose --subtask subtask_zx200_change_pose --json
    """
    from tms_cli.plan_check import check

    session.machines((machine,), False)
    with session.ros() as node:
        found = check(node, session.site(), machine, record, subtask)
    if as_json:
        session.show_json(_as_dict(found))
    else:
        for line in _lines(found, f"{machine}/{record}"):
            click.echo(line)
    ctx.exit(0 if found.refusal is None else 1)


def _lines(found: "Checked", title: str) -> list[str]:
    lines = []
    for answer in found.answers:
        ways = [reason(note) for note in answer.notes] or [say("straight")]
        seconds = _seconds(answer.plan)
        lines.append(say("{record} ({subtask}): {way}; it takes {seconds:.1f} s", record=title, subtask=found.subtask,
                         way="; ".join(ways), seconds=seconds))  # fmt: skip
        if answer.nearest:
            near = "nearest: {bodies}, {metres:.2f} m apart after {seconds:.1f} s"
            bodies = reason(answer.nearest)
            lines.append(say(near, bodies=bodies, metres=answer.clearance, seconds=answer.seconds))
        lines += _path(answer.plan)
    if found.refusal is not None:
        why = texts.sentence(found.refusal, language())
        line = "{record} ({subtask}): it would be refused: {why}"
        lines.append(say(line, record=title, subtask=found.subtask, why=why))
    return lines


def _path(plan: "JointTrajectory") -> list[str]:
    """Some poses of a plan, the first and the last one among them."""
    count = len(plan.points)
    shown = sorted({round(i * (count - 1) / (ROWS - 1)) for i in range(ROWS)})
    names = [name.removesuffix("_joint") for name in plan.joint_names]
    rows = [f"{'s':>8}" + "".join(f"{name:>12}" for name in names)]
    for point in (plan.points[i] for i in shown):
        rows.append(f"{_at(point):8.1f}" + "".join(f"{angle:12.3f}" for angle in point.positions))
    return rows


def _at(point: Any) -> float:
    from tms_machine.stamps import seconds  # here: it loads libraries of ROS, which a list of the verbs does not need

    return seconds(point.time_from_start)


def _seconds(plan: "JointTrajectory") -> float:
    return _at(plan.points[-1])


def _as_dict(found: "Checked") -> dict[str, Any]:
    motions = [
        {
            "notes": [english(note) for note in answer.notes], "seconds": _seconds(answer.plan),
            "clearance": answer.clearance, "nearest": english(answer.nearest), "nearest_after": answer.seconds,
            "joint_names": list(answer.plan.joint_names),
            "path": [{"seconds": _at(point), "positions": list(point.positions)} for point in answer.plan.points],
        }
        for answer in found.answers
    ]  # fmt: skip
    why = found.refusal
    refusal = None if why is None else {"code": why.code, "text": texts.text(why, "en"), "lasting": found.lasting}
    return {"ok": why is None, "subtask": found.subtask, "motions": motions, "refusal": refusal}
