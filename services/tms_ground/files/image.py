"""Heightmaps as PNG images, whose size and heights the user tells: they lie in `map`."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tms_ground.files.samples import Raster, refuse_many
from tms_ground.reasons import GroundFileDamaged, ImageNotGrey
from tms_reason.errors import TmsError

BRIGHTEST = {"L": 255, "I;16": 65535, "I": 65535}  # by Pillow's mode; older releases read 16 bits as "I"


@dataclass(frozen=True)
class Size:
    """Where an image lies, and the heights of its pixels."""

    width: float  # m, along x
    height: float  # m, along y
    elevation: float  # m, of the brightest possible pixel above the darkest one
    base: float = 0.0  # m, of the darkest possible pixel
    offset_x: float = 0.0  # m, of its left edge
    offset_y: float = 0.0  # m, of its lower edge


def read(path: Path, size: Size) -> Raster:
    """The heights of an image; its uppermost row has the largest y.

    Raises:
        TmsError: it is damaged, or not grey.
    """
    from PIL import Image

    try:
        with Image.open(path, formats=("PNG",)) as picture:
            refuse_many(*picture.size)
            if picture.mode not in BRIGHTEST:
                raise TmsError(ImageNotGrey(picture.mode))
            share = np.asarray(picture, dtype=np.float64)[::-1] / BRIGHTEST[picture.mode]
    except (OSError, SyntaxError, ValueError, Image.DecompressionBombError) as error:
        raise TmsError(GroundFileDamaged(str(error))) from error
    rows, columns = share.shape
    dx, dy = size.width / columns, size.height / rows
    return Raster(size.base + share * size.elevation, size.offset_x + dx / 2, size.offset_y + dy / 2, dx, dy)
