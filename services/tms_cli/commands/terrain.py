"""`tms terrain`: heightmaps, their colour images, clouds and meshes in the database."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tms_cli import new_file, session
from tms_cli.open_store import opened
from tms_cli.words import Group

if TYPE_CHECKING:
    from tms_db.terrain import TerrainFile

FILE = click.Path(path_type=Path)
TYPES = click.Choice(["heightmap", "texture", "static", "mesh", "dem"])
METRES = click.FloatRange(min=0)


@click.group(cls=Group)
def command() -> None:
    """Store, list, fetch and remove terrain files; readers get them from tms:db over ROS.

    These talk to the store itself: run them on the PC of tms:db, or wherever TMS_MONGODB_URI is known.

    \b
    Examples:
      tms terrain add yard.png --type heightmap --width 120 --height 80 --elevation 14
      tms terrain list
      tms terrain get yard.png copy.png
    """


@command.command()
@click.argument("file", type=FILE)
@click.option("--type", "type_", type=TYPES, required=True,
              help="heightmap, texture: .png; static: .pcd; mesh: .ply; dem: .npy.")  # fmt: skip
@click.option("--width", type=METRES, help="Metres along x (images).")
@click.option("--height", type=METRES, help="Metres along y (images).")
@click.option("--elevation", type=METRES, help="Metres from the darkest to the brightest possible pixel (images).")
@click.option("--offset-x", type=float, default=0.0, help="Metres from the site's origin.")
@click.option("--offset-y", type=float, default=0.0, help="Metres from the site's origin.")
@session.json_option
def add(
    file: Path,
    type_: str,
    width: float | None,
    height: float | None,
    elevation: float | None,
    offset_x: float,
    offset_y: float,
    as_json: bool,
) -> None:
    """Check a file and store it under its own name.

    \b
    Examples:
      tms terrain add yard.png --type heightmap --width 120 --height 80 --elevation 14
      tms terrain add survey.pcd --type static
    """
    from tms_db.terrain import Terrain
    from tms_db.terrain_files import Size

    size = None
    if width is not None and height is not None and elevation is not None:
        size = Size(width, height, elevation, offset_x, offset_y)
    with opened() as db:
        stored = Terrain(db).add(file, type_, size)
    if as_json:
        session.show_json(_as_dict(stored))
    else:
        click.echo(f"{stored.type} {stored.filename} stored, {stored.length / 2**20:.1f} MB")


@command.command("list")
@session.json_option
def list_(as_json: bool) -> None:
    """List terrain files, newest first.

    \b
    Example:
      tms terrain list --json
    """
    from tms_db.terrain import Terrain

    with opened() as db:
        files = Terrain(db).all()
    if as_json:
        session.show_json([_as_dict(file) for file in files])
        return
    for file in files:
        click.echo(f"{file.type:<10} {file.filename:<30} {file.length / 2**20:>8.1f} MB  {file.time}")
    if not files:
        click.echo("none yet: `tms terrain add FILE` stores one", err=True)


@command.command()
@click.argument("name")
@click.argument("file", type=FILE)
@session.json_option
def get(name: str, file: Path, as_json: bool) -> None:
    """Write the newest terrain called NAME into FILE, which must not be there yet.

    \b
    Example:
      tms terrain get yard.png copy.png
    """
    from tms_db.terrain import Terrain, missing

    with opened() as db:
        terrain = Terrain(db)
        found = next(iter(terrain.all(filename=name)), None)
        if found is None:
            raise missing(name)
        data = terrain.read(found)
    new_file.write(file, data)
    if as_json:
        session.show_json({**_as_dict(found), "file": str(file)})
    else:
        click.echo(f"{file}: {found.type}, {len(data) / 2**20:.1f} MB")


@command.command()
@click.argument("name")
@session.json_option
def rm(name: str, as_json: bool) -> None:
    """Remove all terrain files of a name.

    \b
    Example:
      tms terrain rm yard.png
    """
    from tms_db.terrain import Terrain

    with opened() as db:
        removed = Terrain(db).remove(name)
    if as_json:
        session.show_json({"removed": removed})
    else:
        click.echo(f"{name}: {removed} removed")


def _as_dict(stored: "TerrainFile") -> dict[str, Any]:
    from tms_db.terrain import SIZES

    sizes = {name: stored.more[name] for name in SIZES if name in stored.more}
    return {
        "filename": stored.filename, "type": stored.type, "id": stored.id, "time": stored.time,
        "bytes": stored.length, **sizes,
    }  # fmt: skip
