"""`tms ground`: grounds of the site in the database, from files; volumes between them and against a design."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tms_cli import ground_options, grounds, new_file, session
from tms_cli.ground_options import Finite, Level, Polygon, Slope
from tms_cli.open_store import opened
from tms_cli.words import Group, say

if TYPE_CHECKING:
    from tms_soil.surface import Bounds, Point

FILE = click.Path(path_type=Path)
METRES = Finite(min=0, min_open=True)
ANY = Finite()
inside_option = click.option("--inside", type=Polygon(), help="Count only what lies in this polygon.")


@click.group(cls=Group)
def command() -> None:
    """Import, show, compare and export grounds of the site.

    A SNAPSHOT is `last`, `first`, or the beginning of its time: the newest that fits counts. These talk to the store
    itself: run them on the PC of tms:db, or wherever TMS_MONGODB_URI is known.

    \b
    Examples:
      tms ground import survey.laz --epsg 6677
      tms ground volume 2026-11-25 last
      tms ground volume last --plane 1.5
    """


@command.command("import")
@click.argument("file", type=FILE)
@click.option("--epsg", type=int, help="Code of its coordinates, where the file does not tell them.")
@click.option("--map", "in_map", is_flag=True, help="Its coordinates are those of `map`.")
@click.option("--area", type=ANY, nargs=4, help="Least x and y, largest x and y in metres; default: the site file's.")
@click.option("--cell", type=Finite(0.01, 10), help="Side of a cell in metres; default: the site file's.")
@click.option("--surface", help="Name of a surface, where a LandXML holds several.")
@click.option("--keep-holes", is_flag=True, help="Let places without a height be unknown.")
@click.option("--width", type=METRES, help="Metres along x (images).")
@click.option("--height", type=METRES, help="Metres along y (images).")
@click.option("--elevation", type=METRES, help="Metres from the darkest to the brightest possible pixel (images).")
@click.option("--base", type=ANY, default=0.0, help="Height of the darkest pixel in metres (images).")
@click.option("--offset-x", type=ANY, default=0.0, help="Metres from the site's origin.")
@click.option("--offset-y", type=ANY, default=0.0, help="Metres from the site's origin.")
@session.json_option
def import_(file: Path, area: "Bounds | None", cell: float | None, as_json: bool, **told: Any) -> None:
    """Check a file of heights and store it as the ground of now.

    It may be a heightmap (.png, with its sizes), a GeoTIFF, an ASCII grid (.asc), a point cloud (.las, .laz) or a
    surface of LandXML. What is wrong with it is told, and then nothing is stored.

    \b
    Examples:
      tms ground import survey.laz --epsg 6677
      tms ground import yard.png --width 120 --height 80 --elevation 14
      tms ground import design_area.asc --map --area 0 0 40 30
    """
    from tms_db.ground import GroundSnapshots

    ground = grounds.read(file, grounds.given(**told), area, cell)
    with opened() as db:
        stored = GroundSnapshots(db).add(ground, file.name)
    if as_json:
        session.show_json(grounds.as_dict(stored))
    else:
        click.echo(
            say("stored as the ground of {time}: {size}", time=grounds.time(stored), size=grounds.extent(stored))
        )


@command.command()
@click.option("--note", default="", help="For people: why.")
@session.json_option
def snapshot(note: str, as_json: bool) -> None:
    """Have tms:ground store the ground of now, as machines have changed it.

    It does so by itself at the end of each day. This asks the process, and runs on any PC of the site.

    \b
    Examples:
      tms ground snapshot
      tms ground snapshot --note "before the rain"
    """
    from tms_msg_ground.srv import TakeSnapshot

    with session.ros() as node:
        found = session.call(node, TakeSnapshot, "/tms/ground/take_snapshot", seconds=90.0, source=note or "snapshot")
    if as_json:
        session.show_json({"taken_at": found.taken_at})
    else:
        click.echo(say("stored as the ground of {time}", time=found.taken_at))


@command.command("list")
@session.json_option
def list_(as_json: bool) -> None:
    """List the stored grounds, newest first.

    \b
    Example:
      tms ground list --json
    """
    from tms_db.ground import GroundSnapshots

    with opened() as db:
        found = GroundSnapshots(db).all()
    if as_json:
        session.show_json([grounds.as_dict(one) for one in found])
        return
    for one in found:
        click.echo(f"{grounds.time(one)}  {grounds.extent(one):<44} {one.file.length / 2**20:>6.1f} MB  {one.source}")
    if not found:
        click.echo(say("there is none yet: `tms ground import FILE` stores one"), err=True)


@command.command()
@click.argument("snapshot", default="last")
@session.json_option
def show(snapshot: str, as_json: bool) -> None:
    """Show size and heights of a ground.

    \b
    Examples:
      tms ground show
      tms ground show 2026-11-25 --json
    """
    import numpy as np

    with opened() as db:
        found, ground = grounds.one(db, snapshot)
    known = ground.z[np.isfinite(ground.z)]
    facts = {"known_m2": known.size * ground.cell**2, "whole_m2": ground.z.size * ground.cell**2}
    heights = {}
    if known.size:
        heights = {"least_m": float(known.min()), "mean_m": float(known.mean()), "most_m": float(known.max())}
    if as_json:
        session.show_json({**grounds.as_dict(found), **facts, **heights})
        return
    click.echo(f"{grounds.time(found)}  {grounds.extent(found)}  {found.source}")
    click.echo(say("known: {known_m2:.1f} of {whole_m2:.1f} m²", **facts))
    if heights:
        click.echo(say("heights: {least_m:.2f} to {most_m:.2f} m, mean {mean_m:.2f} m", **heights))


@command.command()
@click.argument("snapshots", nargs=-1)
@click.option("--plane", type=Level(), help="Against a plane: its height, or height and slopes along x and y.")
@click.option("--pit", type=Polygon(), help="Against a pit: the corners of its floor.")
@click.option("--floor", type=ANY, help="Height of the pit's floor in metres.")
@click.option("--rim", type=ANY, help="Height at which the pit's slopes end in metres.")
@click.option("--slope", type=Slope(), default="1:1.0", show_default=True, help="Slopes of the pit.")
@click.option("--design", "file", type=FILE, help="Against a surface in a file (LandXML, GeoTIFF, ASCII grid).")
@click.option("--epsg", type=int, help="Code of its coordinates, where the file does not tell them.")
@click.option("--map", "in_map", is_flag=True, help="Its coordinates are those of `map`.")
@click.option("--surface", help="Name of a surface, where a LandXML holds several.")
@inside_option
@session.json_option
def volume(
    snapshots: tuple[str, ...],
    epsg: int | None,
    in_map: bool,
    surface: str | None,
    inside: "tuple[Point, ...] | None",
    as_json: bool,
    **told: Any,
) -> None:
    """Cut and fill between two grounds, or what a ground still needs to become a design.

    SNAPSHOTS are the earlier and the later one (default: first and last); with a design it is one (default: last).

    \b
    Examples:
      tms ground volume 2026-11-25 last
      tms ground volume last --plane 1.5 --inside "0,0 20,0 20,10 0,10"
      tms ground volume last --pit "4,4 9,4 9,9 4,9" --floor -2 --rim 0 --slope 1:1.5
      tms ground volume last --design pit.xml --surface Design
    """
    from tms_ground.files.reading import Given
    from tms_soil import volumes

    wanted = ground_options.design(**told)
    if len(snapshots) > (2 if wanted is None else 1):
        raise click.UsageError(say("too many snapshots"))
    with opened() as db:
        if wanted is None:
            before, after = (*snapshots, "last")[:2] if snapshots else ("first", "last")
            _, ground = grounds.one(db, after)
            found = volumes.between(grounds.one(db, before)[1], ground, grounds.mask(ground, inside))
        else:
            _, ground = grounds.one(db, snapshots[0] if snapshots else "last")
            if isinstance(wanted, Path):
                given = Given(in_map, epsg, None, surface, partial=True)
                wanted = grounds.read(wanted, given, ground.bounds, ground.cell)
            found = volumes.against(ground, wanted, grounds.mask(ground, inside))
    grounds.show_volumes(found, as_json=as_json)


@command.command()
@click.argument("snapshot")
@click.argument("file", type=FILE)
@session.json_option
def export(snapshot: str, file: Path, as_json: bool) -> None:
    """Write a ground into FILE, which must not be there yet: an ASCII grid in `map`, or a GeoTIFF on the site's plane.

    \b
    Examples:
      tms ground export last ground.asc
      tms ground export 2026-11-25 ground.tif
    """
    if file.suffix.lower() not in grounds.EXPORTS:
        raise click.UsageError(say("the file's name must end with .asc or .tif"))
    with opened() as db:
        found, ground = grounds.one(db, snapshot)
    with new_file.written(file):
        grounds.write(file, ground)
    if as_json:
        session.show_json({**grounds.as_dict(found), "file": str(file)})
    else:
        click.echo(f"{file}: {grounds.time(found)}, {grounds.extent(found)}")


@command.command()
@click.argument("snapshot")
@session.json_option
def rm(snapshot: str, as_json: bool) -> None:
    """Remove one ground, for example one from a wrong file.

    \b
    Example:
      tms ground rm last
    """
    from tms_db.ground import GroundSnapshots

    with opened() as db:
        stored = GroundSnapshots(db)
        found = stored.find(snapshot)
        stored.remove(found)
    if as_json:
        session.show_json({"removed": grounds.as_dict(found)})
    else:
        click.echo(say("removed: {time}, {source}", time=grounds.time(found), source=found.source))


@command.command()
@click.argument("before")
@click.argument("after", default="last")
@click.option("--picture", type=FILE, help="Write a map of the change into this .png, too.")
@inside_option
@session.json_option
def diff(before: str, after: str, picture: Path | None, inside: "tuple[Point, ...] | None", as_json: bool) -> None:
    """Show what has changed between two grounds, and where most.

    \b
    Example:
      tms ground diff first last --picture change.png
    """
    from tms_report import ground_map, map_picture
    from tms_soil import volumes

    with opened() as db:
        _, ground = grounds.one(db, after)
        old = grounds.one(db, before)[1]
    mask = grounds.mask(ground, inside)
    change = ground_map.change(old, ground, mask)
    if picture is not None:
        new_file.write(picture, map_picture.picture(ground, change))
    grounds.show_volumes(volumes.between(old, ground, mask), ground_map.extremes(ground, change), as_json=as_json)
