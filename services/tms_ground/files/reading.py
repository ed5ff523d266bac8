"""Reads a file of heights onto a grid in `map`, and refuses one that is not fit to be a ground."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tms_ground.files import ascii_grid, cloud, geotiff, image, landxml
from tms_ground.files.samples import MAX_CELLS, Places, Samples
from tms_ground.frame import SiteFrame
from tms_ground.reasons import (
    FrameNotTold,
    FramesDiffer,
    GroundFile,
    GroundFileDamaged,
    GroundFileKind,
    GroundFileMissing,
    HasHoles,
    ImageNeedsSize,
    ManyCells,
    NoOrigin,
    NotMetres,
    NotOnSite,
)
from tms_reason.errors import TmsError
from tms_soil.surface import Array, Bounds, Heights, grid

ENDINGS = (".png", ".tif", ".tiff", ".asc", ".las", ".laz", ".xml", ".landxml")
LOWEST, HIGHEST = -1000.0, 9000.0  # m; heights of land are between these, those in mm or feet mostly not
BAD = "BAD_GROUND"  # code of all errors


@dataclass(frozen=True)
class Given:
    """What a user tells about a file."""

    in_map: bool = False  # its coordinates are those of `map`
    epsg: int | None = None  # code of its coordinates, where it does not tell them itself
    size: image.Size | None = None  # of an image
    surface: str | None = None  # name, in a file with several
    keep_holes: bool = False  # cells without a height may stay unknown
    partial: bool = False  # it may cover a part of the area, as designs do


class _Map:
    """Coordinates of a file that is in `map` already."""

    def to_map(self, x: Array, y: Array) -> tuple[Array, Array]:
        return x, y

    from_map = to_map


@dataclass(frozen=True)
class _World:
    """Coordinates of a file with a code."""

    frame: SiteFrame
    epsg: int

    def to_map(self, x: Array, y: Array) -> tuple[Array, Array]:
        return self.frame.to_map(x, y, self.epsg)

    def from_map(self, x: Array, y: Array) -> tuple[Array, Array]:
        return self.frame.from_map(x, y, self.epsg)


def read(path: Path, area: Bounds, cell: float, frame: SiteFrame | None, given: Given) -> Heights:
    """The heights of a file over an area of `map`.

    Args:
        path: of the file; its ending tells the format.
        area: bounds [m] that it must cover.
        cell: side of a cell [m].
        frame: of the site; None: it has no origin, and only files in `map` can be read.
        given: what the user tells about the file.

    Raises:
        TmsError: BAD_GROUND; names the file and what is wrong with it.
    """
    try:
        return _read(path, area, cell, frame, given)
    except TmsError as error:
        raise TmsError(GroundFile(str(path), error.reason), BAD) from error
    except OSError as error:
        raise TmsError(GroundFile(str(path), GroundFileDamaged(str(error.strerror))), BAD) from error
    except MemoryError as error:  # a head that tells billions of points or pixels
        raise TmsError(GroundFile(str(path), GroundFileDamaged("MemoryError")), BAD) from error


def _read(path: Path, area: Bounds, cell: float, frame: SiteFrame | None, given: Given) -> Heights:
    if not path.is_file():
        raise TmsError(GroundFileMissing())
    cells = (area[2] - area[0]) * (area[3] - area[1]) / cell**2
    if cells > MAX_CELLS:
        raise TmsError(ManyCells(int(cells), cell, MAX_CELLS))
    samples = _samples(path, given)
    places = _places(samples, frame, given)
    wanted = grid(area, cell)
    z = samples.over(wanted.x0, wanted.y0, cell, (wanted.z.shape[0], wanted.z.shape[1]), places)
    _check(z, wanted, _bounds_in_map(samples.bounds, places), given)
    height = frame.origin.height if frame is not None and not isinstance(places, _Map) else 0.0
    z -= height  # in place: there may be millions of cells
    return Heights(wanted.x0, wanted.y0, cell, z)


def _samples(path: Path, given: Given) -> Samples:
    ending = path.suffix.lower()
    if ending == ".png":
        if given.size is None:
            raise TmsError(ImageNeedsSize())
        return image.read(path, given.size)
    if ending in (".tif", ".tiff"):
        return geotiff.read(path)
    if ending == ".asc":
        return ascii_grid.read(path)
    if ending in (".las", ".laz"):
        return cloud.read(path)
    if ending in (".xml", ".landxml"):
        return landxml.read(path, given.surface)
    raise TmsError(GroundFileKind(ENDINGS))


def _places(samples: Samples, frame: SiteFrame | None, given: Given) -> Places:
    told = samples.epsg
    if given.in_map or given.size is not None:
        if told is not None:
            raise TmsError(FramesDiffer(told, "map"))
        return _Map()
    if told is not None and given.epsg not in (None, told):
        raise TmsError(FramesDiffer(told, str(given.epsg)))
    epsg = told or given.epsg
    if epsg is None:
        raise TmsError(FrameNotTold())
    if frame is None:
        raise TmsError(NoOrigin(epsg))
    places = _World(frame, epsg)
    places.to_map(np.zeros(1), np.zeros(1))  # refuses an unknown code now
    return places


def _bounds_in_map(bounds: Bounds, places: Places) -> Bounds:
    x0, y0, x1, y1 = bounds
    x, y = places.to_map(np.array([x0, x1, x0, x1]), np.array([y0, y0, y1, y1]))
    return float(x.min()), float(y.min()), float(x.max()), float(y.max())


def _check(z: Array, wanted: Heights, bounds: Bounds, given: Given) -> None:
    """Refuse heights with holes, of less than the area, or in another unit."""
    known = np.isfinite(z)
    area = wanted.bounds
    slack = wanted.cell  # clouds and triangles end at their last point
    outside = any(b > a + slack for b, a in zip(bounds[:2], area[:2], strict=True)) or any(
        b < a - slack for b, a in zip(bounds[2:], area[2:], strict=True)
    )
    if not known.any() or (outside and not given.partial):
        raise TmsError(NotOnSite(100.0 * float(known.mean()), _shown(area), _shown(bounds)))
    least, most = float(z[known].min()), float(z[known].max())
    if least < LOWEST or most > HIGHEST:
        raise TmsError(NotMetres(least, most))
    if not (known.all() or given.keep_holes or given.partial):
        row, column = (int(found[0]) for found in np.nonzero(~known))
        size = wanted.cell**2
        x, y = wanted.x0 + (column + 0.5) * wanted.cell, wanted.y0 + (row + 0.5) * wanted.cell
        raise TmsError(HasHoles(float(np.count_nonzero(~known)) * size, z.size * size, x, y))


def _shown(bounds: Bounds) -> str:
    x0, y0, x1, y1 = bounds
    return f"x [{x0:.1f}, {x1:.1f}] m, y [{y0:.1f}, {y1:.1f}] m"
