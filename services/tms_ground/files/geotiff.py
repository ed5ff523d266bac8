"""GeoTIFF with one height a pixel, read by Pillow, which the project has anyway; GDAL would add 90 MB to the image.

Tags and keys: OGC GeoTIFF 1.1 (19-008r4), sections 6 and 7, and annex D for codes of units.
"""

from pathlib import Path
from typing import Any

import numpy as np

from tms_ground.files.samples import Raster, refuse_large, refuse_many
from tms_ground.frame import FIRST_PLANE
from tms_ground.reasons import (
    GroundFileDamaged,
    LengthUnit,
    NotAlongPlane,
    TiffBands,
    TiffNotPlaced,
    TiffTurned,
)
from tms_ground.settings import Origin
from tms_reason.errors import TmsError
from tms_soil.surface import Heights

SCALE, TIE_POINT, TRANSFORMATION, KEYS, NO_DATA = 33550, 33922, 34264, 34735, 42113  # tags
MODEL_TYPE, RASTER_TYPE, GEODETIC, PROJECTED, LENGTH_UNIT, HEIGHT_UNIT = 1024, 1025, 2048, 3072, 3076, 4099  # keys
PROJECTED_MODEL = 1  # of MODEL_TYPE
PIXEL_IS_AREA, PIXEL_IS_POINT = 1, 2  # of RASTER_TYPE: the tie point is the corner of a pixel, or its centre
TEXT, SHORT, DOUBLE = 2, 3, 12  # types of tags
UNKNOWN = -9999
METRE = 9001
OWN = 32767  # user-defined: the code is not told
HEIGHTS = ("F", "I", "I;16", "I;16S", "I;16B", "I;16BS", "L")  # Pillow's modes of one number a pixel


def read(path: Path) -> Raster:
    """The heights of a GeoTIFF.

    Raises:
        TmsError: it is damaged, has no or several bands, does not tell where it lies, or not in metres.
    """
    from PIL import Image

    refuse_large(path)
    try:
        with Image.open(path, formats=("TIFF",)) as picture:
            refuse_many(*picture.size)
            tags: Any = picture.tag_v2  # type: ignore[attr-defined]
            if picture.mode not in HEIGHTS:
                raise TmsError(TiffBands(picture.mode))
            z = np.asarray(picture, dtype=np.float64)
    except (OSError, SyntaxError, ValueError, Image.DecompressionBombError) as error:
        raise TmsError(GroundFileDamaged(str(error))) from error
    keys = _keys(tags.get(KEYS, ()))
    for key in (LENGTH_UNIT, HEIGHT_UNIT):
        if keys.get(key, METRE) not in (METRE, OWN):
            raise TmsError(LengthUnit(f"EPSG {keys[key]}"))
    x, y, dx, dy = _place(tags, keys.get(RASTER_TYPE) == PIXEL_IS_POINT)
    code = keys.get(PROJECTED, keys.get(GEODETIC, OWN))
    return Raster(
        _known(z, tags.get(NO_DATA))[::-1], x, y - (z.shape[0] - 1) * dy, dx, dy, None if code == OWN else code
    )


def write(path: Path, ground: Heights, origin: Origin | None) -> None:
    """Write heights into a new file, in the coordinates of the site's plane.

    Raises:
        TmsError: the site's origin is on no plane, or `map` is turned against it.
        OSError: the file is there already, or cannot be written.
    """
    from PIL import Image
    from PIL.TiffImagePlugin import ImageFileDirectory_v2

    if origin is None or origin.plane is None or origin.north is None or origin.east is None or origin.yaw:
        raise TmsError(NotAlongPlane())
    top = origin.north + ground.bounds[3]
    keys = {MODEL_TYPE: PROJECTED_MODEL, RASTER_TYPE: PIXEL_IS_AREA, PROJECTED: FIRST_PLANE + origin.plane}
    tags = ImageFileDirectory_v2()
    tags[SCALE] = (ground.cell, ground.cell, 0.0)
    tags[TIE_POINT] = (0.0, 0.0, 0.0, origin.east + ground.x0, top, 0.0)
    tags[KEYS] = (1, 1, 0, len(keys), *(word for key, value in keys.items() for word in (key, 0, 1, value)))
    tags[NO_DATA] = str(UNKNOWN)
    tags.tagtype.update({SCALE: DOUBLE, TIE_POINT: DOUBLE, KEYS: SHORT, NO_DATA: TEXT})
    z = np.where(np.isfinite(ground.z), ground.z + origin.height, UNKNOWN)[::-1].astype(np.float32)
    with path.open("xb") as file:
        Image.fromarray(z).save(file, "TIFF", tiffinfo=tags, compression="tiff_adobe_deflate")


def _keys(words: Any) -> dict[int, int]:
    """Keys with a short value; those whose value lies in another tag are texts and numbers that nobody needs here."""
    entries = [tuple(words[at : at + 4]) for at in range(4, len(words) - 3, 4)]
    return {key: value for key, tag, _, value in entries if tag == 0}


def _place(tags: Any, point: bool) -> tuple[float, float, float, float]:
    """Centre of the first pixel of the first row, and the sides of a pixel; the first row has the largest y."""
    if TRANSFORMATION in tags:
        a, b, _, x, d, e, _, y = tags[TRANSFORMATION][:8]
        if b or d or a <= 0 or e >= 0:
            raise TmsError(TiffTurned())
        dx, dy = a, -e
    elif SCALE in tags and len(tags.get(TIE_POINT, ())) >= 6:
        dx, dy = tags[SCALE][:2]
        column, row, _, x, y, _ = tags[TIE_POINT][:6]
        x, y = x - column * dx, y + row * dy
    else:
        raise TmsError(TiffNotPlaced())
    if not (dx > 0 and dy > 0 and np.isfinite([x, y, dx, dy]).all()):
        raise TmsError(TiffTurned())
    return (x, y, dx, dy) if point else (x + dx / 2, y - dy / 2, dx, dy)


def _known(z: Any, no_data: Any) -> Any:
    """NaN for pixels of the value that GDAL writes for those without a height."""
    try:
        unknown = float(str(no_data).strip("\0 "))
    except ValueError:
        unknown = np.nan
    near = np.isclose(z, unknown, rtol=1e-6, atol=0.0)  # the text may have fewer digits than the number
    return np.where(np.isfinite(z) & ~near, z, np.nan)
