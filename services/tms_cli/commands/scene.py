"""`tms scene`: what an excavator's planner plans among now."""

from typing import TYPE_CHECKING, Any

import click

from tms_cli import session
from tms_cli.words import english, reason
from tms_config.reasons import NoPlannedArm
from tms_reason.errors import ConfigError

if TYPE_CHECKING:
    from tms_msg_rp.msg import SceneBody
    from tms_msg_rp.srv import GetScene


@click.command()
@click.argument("machine")
@session.json_option
def command(machine: str, as_json: bool) -> None:
    """Show what an excavator keeps clear of now: itself, other machines, records, with margins and ages.

    Places and sizes are in m, in the base_link of the excavator; MARGIN is what its planner adds on each side: padding,
    what a machine may have moved since it told its place, the error of a simplified surface. RViz draws the same from
    the topic /MACHINE/rp/scene.

    \b
    Examples:
      tms scene zx200
      tms scene zx200 --json
    """
    from tms_msg_rp.srv import GetScene

    session.machines((machine,), False)
    if session.site().model_of(machine).planner is None:
        raise ConfigError(NoPlannedArm(machine))
    with session.ros() as node:
        found = session.call(node, GetScene, f"/{machine}/rp/get_scene")
    if as_json:
        return session.show_json(_as_dict(found))
    click.echo(f"{'KIND':<8} {'X':>7} {'Y':>7} {'Z':>7} {'SIZE':>20} {'MARGIN':>7} {'AGE':>8}  WHAT")
    for one in found.bodies:
        click.echo(_row(one))
    for area in found.areas:
        at, size = area.centre, _size(area.size)
        click.echo(f"{'area':<8} {at.x:7.2f} {at.y:7.2f} {at.z:7.2f} {size:>20} {'':>7} {'':>8}  {area.record}")
    return None


def _row(one: "SceneBody") -> str:
    at, size = one.pose.position, _size(one.size)
    place = f"{one.kind:<8} {at.x:7.2f} {at.y:7.2f} {at.z:7.2f}"
    return f"{place} {size:>20} {one.margin:7.2f} {one.age:6.1f} s  {reason(one.name)}"


def _size(of: Any) -> str:
    return f"{of.x:.2f} x {of.y:.2f} x {of.z:.2f}"


def _as_dict(found: "GetScene.Response") -> dict[str, Any]:
    return {
        "bodies": [
            {
                "kind": one.kind, "name": english(one.name), "position": _xyz(one.pose.position),
                "orientation": [*_xyz(one.pose.orientation), one.pose.orientation.w], "size": _xyz(one.size),
                "margin": one.margin, "age": one.age, "triangles": len(one.triangles) // 3,
            }
            for one in found.bodies
        ],
        "areas": [{"record": one.record, "centre": _xyz(one.centre), "size": _xyz(one.size)} for one in found.areas],
        "way": [_xyz(place) for place in found.way],
    }  # fmt: skip


def _xyz(of: Any) -> list[float]:
    return [of.x, of.y, of.z]
