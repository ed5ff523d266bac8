"""Small files of heights in each format, of one sloping plane on plane 9 of Japan (EPSG 6677)."""

from pathlib import Path
from typing import Any

import laspy
import numpy as np
from PIL import Image, TiffImagePlugin
from pyproj import CRS

NORTH, EAST, LEVEL = -36000.0, -7000.0, 12.0  # m, place of the site's origin on the plane, and its height
SIDE = (-2.0, 22.0, 12.0)  # m, map: where files begin, and end along x and y


def height(x: Any, y: Any) -> Any:
    """Height [m] over z = 0 of `map` at a place in `map`."""
    return 1.0 + 0.05 * x - 0.02 * y


def lattice(step: float) -> tuple[np.ndarray, np.ndarray]:
    """Places from corner to corner of the files, in `map`."""
    begin, right, top = SIDE
    x, y = np.meshgrid(np.arange(begin, right + step / 2, step), np.arange(begin, top + step / 2, step))
    return x, y


def ascii_grid(path: Path, cell: float = 0.5, **head: object) -> Path:
    begin, right, top = SIDE
    x, y = np.meshgrid(np.arange(begin + cell / 2, right, cell), np.arange(begin + cell / 2, top, cell))
    keys = {"ncols": x.shape[1], "nrows": x.shape[0], "xllcorner": EAST + begin, "yllcorner": NORTH + begin,
            "cellsize": cell, "NODATA_value": -9999} | head  # fmt: skip
    rows = [" ".join(f"{z:.6f}" for z in row) for row in (height(x, y) + LEVEL)[::-1]]
    text = "".join(f"{key} {value}\n" for key, value in keys.items() if value is not None)
    path.write_text(text + "\n".join(rows) + "\n")
    return path


def tiff(path: Path, z: Any, keys: dict[int, int], doubles: dict[int, tuple[float, ...]], **save: Any) -> Path:
    """Heights with their first row in the south, GeoTIFF's keys, and tags of doubles."""
    tags = TiffImagePlugin.ImageFileDirectory_v2()
    for tag, values in doubles.items():
        tags[tag], tags.tagtype[tag] = values, 12
    tags[34735] = (1, 1, 0, len(keys), *(word for key, value in keys.items() for word in (key, 0, 1, value)))
    tags[42113] = "-9999"
    tags.tagtype.update({34735: 3, 42113: 2})
    Image.fromarray(z[::-1].astype(np.float32)).save(path, "TIFF", tiffinfo=tags, **save)
    return path


def geotiff(
    path: Path, epsg: int = 6677, point: bool = False, unit: int = 9001, scale: bool = True, hole: float | None = None,
    **save: Any,
) -> Path:  # fmt: skip
    cell, (begin, right, top) = 0.5, SIDE
    x, y = np.meshgrid(np.arange(begin + cell / 2, right, cell), np.arange(begin + cell / 2, top, cell))
    half = cell / 2 if point else 0.0
    corner = (0.0, 0.0, 0.0, EAST + begin + half, NORTH + top - half, 0.0)
    z = height(x, y) + LEVEL
    if hole is not None:
        z[18, 9] = hole  # at (2.75, 7.25)
    keys = {1024: 1, 1025: 2 if point else 1, 3072: epsg, 3076: unit}
    return tiff(path, z, keys, {33550: (cell, cell, 0.0), 33922: corner} if scale else {}, **save)


def cloud(path: Path, step: float = 0.25, epsg: int | str | None = 6677, height_scale: float = 1.0) -> Path:
    """With a layer of leaves 3 m above, noise far below, and a stripe of unclassified points on the ground."""
    x, y = (one.ravel() for one in lattice(step))
    head = laspy.LasHeader(point_format=6, version="1.4")
    head.offsets, head.scales = [EAST, NORTH, 0.0], [0.001, 0.001, 0.0001]
    if epsg is not None:
        head.add_crs(CRS.from_user_input(epsg))
    las = laspy.LasData(head)
    ground = height(x, y) + LEVEL
    las.x, las.y = np.tile(x + EAST, 3), np.tile(y + NORTH, 3)
    las.z = np.concatenate([ground, ground + 3.0, ground - 50.0]) * height_scale
    las.classification = np.repeat(np.array([2, 5, 7], dtype=np.uint8), x.size)
    las.classification[: x.size][(x > 4) & (x < 6)] = 1
    las.classification[x.size : 2 * x.size][(x > 4) & (x < 6)] = 18
    las.write(path)
    return path


def landxml(
    path: Path, unit: str = "meter", system: str = 'horizontalCoordinateSystemName="9(X,Y)"', **parts: str
) -> Path:
    """Two triangles over all; a third one, which is not part of the surface, and breaklines."""
    begin, right, top = SIDE
    corners = [(begin, begin), (right, begin), (right, top), (begin, top)]
    points = [(NORTH + y, EAST + x, height(x, y) + LEVEL) for x, y in corners] + [(NORTH + 8, EAST, 900.0)]
    rows = [f'<P id="{10 + at}">{north!r} {east!r} {z!r}</P>' for at, (north, east, z) in enumerate(points)]
    faces = ["<F>10 11 12</F>", "<F>10 12 13</F>", '<F i="1">10 11 14</F>']
    surface = f"""<Surface name="Design"><SourceData><Breaklines><Breakline><PntList3D>1 2 3</PntList3D></Breakline>
</Breaklines></SourceData><Definition surfType="TIN"><Pnts>{parts.get("points", "".join(rows))}</Pnts>
<Faces>{parts.get("faces", "".join(faces))}</Faces></Definition></Surface>"""
    path.write_text(f"""<?xml version="1.0" encoding="UTF-8"?>
<LandXML xmlns="http://www.landxml.org/schema/LandXML-1.2" version="1.2">
<Units><Metric linearUnit="{unit}" areaUnit="squareMeter"/></Units><CoordinateSystem name="CRS1" {system}/>
<Surfaces>{parts.get("surfaces", surface)}</Surfaces></LandXML>""")
    return path
