"""What the verbs of `tms ground` share: reading files and snapshots, and showing them."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tms_cli import session
from tms_cli.words import say
from tms_reason.errors import TmsError
from tms_reason.reasons import KeyProblem

if TYPE_CHECKING:
    from tms_db.ground import Snapshot
    from tms_db.store import Db
    from tms_ground.files.reading import Given
    from tms_soil.surface import Bounds, Heights, Mask, Point
    from tms_soil.volumes import Volumes

EXPORTS = (".asc", ".tif")
CELL = 0.2  # m, where the site file tells none


def given(
    in_map: bool,
    epsg: int | None,
    surface: str | None,
    keep_holes: bool,
    width: float | None,
    height: float | None,
    elevation: float | None,
    **place: float,
) -> "Given":
    """What the options of an import tell about a file."""
    from tms_ground.files.image import Size
    from tms_ground.files.reading import Given

    size = None
    if width is not None and height is not None and elevation is not None:
        size = Size(width, height, elevation, **place)
    return Given(in_map, epsg, size, surface, keep_holes)


def read(file: Path, given: "Given", area: "Bounds | None", cell: float | None) -> "Heights":
    """The heights of a file over an area; what is not given comes from the site file."""
    from tms_ground import settings
    from tms_ground.files import reading
    from tms_ground.frame import SiteFrame
    from tms_ground.reasons import AreaInsideOut

    site = session.site()
    told = settings.ground_of(site) if area else settings.needed(site)
    bounds = area or settings.needed(site).area
    if not (bounds[0] < bounds[2] and bounds[1] < bounds[3]):
        raise TmsError(KeyProblem("--area", AreaInsideOut()))
    frame = SiteFrame(told.origin) if told is not None and told.origin is not None else None
    return reading.read(file, bounds, cell or (told.cell if told is not None else CELL), frame, given)


def write(file: Path, ground: "Heights") -> None:
    """Write a ground into a new file of one of EXPORTS; OSError where that is refused."""
    from tms_ground.files import ascii_grid, geotiff
    from tms_ground.settings import needed

    if file.suffix.lower() == ".asc":
        ascii_grid.write(file, ground)
    else:
        geotiff.write(file, ground, needed(session.site()).origin)


def one(db: "Db", word: str) -> "tuple[Snapshot, Heights]":
    """The snapshot that a word means, with its heights."""
    from tms_db.ground import GroundSnapshots

    grounds = GroundSnapshots(db)
    found = grounds.find(word)
    return found, grounds.read(found)


def mask(ground: "Heights", polygon: "tuple[Point, ...] | None") -> "Mask | None":
    """Which cells are inside a polygon; None where there is none."""
    from tms_soil.surface import inside

    return None if polygon is None else inside(polygon, *ground.centres)


def show_volumes(found: "Volumes", more: dict[str, Any] | None = None, *, as_json: bool) -> None:
    """Print cut and fill, and where the extremes are."""
    if as_json:
        session.show_json({
            "cut_m3": found.cut, "fill_m3": found.fill, "net_m3": found.net, "area_m2": found.area,
            "unknown_m2": found.unknown, "cut_at_most_m3": found.cut_at_most, "fill_at_most_m3": found.fill_at_most,
            **(more or {}),
        })  # fmt: skip
        return
    line = "cut {cut:.2f} m³, fill {fill:.2f} m³, net {net:+.2f} m³"
    click.echo(say(line, cut=found.cut, fill=found.fill, net=found.net))
    if found.unknown:
        unknown = "unknown: {area:.1f} m²; with them cut {cut:.2f} m³ and fill {fill:.2f} m³ at most"
        click.echo(say(unknown, area=found.unknown, cut=found.cut_at_most, fill=found.fill_at_most))
    if more:
        click.echo(say("lowered most: {deepest_m:.2f} m at ({deepest_x:.1f}, {deepest_y:.1f})", **more))
        click.echo(say("raised most: {highest_m:.2f} m at ({highest_x:.1f}, {highest_y:.1f})", **more))


def time(one: "Snapshot") -> str:
    """When it was taken, in local time; a part of it finds it again."""
    return one.taken_at.astimezone().isoformat(timespec="milliseconds")


def extent(one: "Snapshot") -> str:
    """Its size and that of its cells."""
    width, height = one.columns * one.cell, one.rows * one.cell
    return f"{width:.1f} x {height:.1f} m, {one.cell:g} m"


def as_dict(one: "Snapshot") -> dict[str, Any]:
    """A snapshot for --json."""
    return {
        "taken_at": one.taken_at.isoformat(), "source": one.source, "x0": one.x0, "y0": one.y0, "cell": one.cell,
        "rows": one.rows, "columns": one.columns, "bytes": one.file.length,
    }  # fmt: skip
