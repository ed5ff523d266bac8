"""Checks terrain files before they are stored: an image or a cloud that cannot be read is refused."""

import struct
import zlib
from dataclasses import dataclass
from pathlib import Path

from tms_db.reasons import (
    ImageDamaged,
    ImageEnds,
    ImageNoHeader,
    ImageSides,
    NoColourPixels,
    NoHeightPixels,
    NoPng,
    TerrainBegins,
    TerrainEnding,
    TerrainLarge,
    TerrainNoFile,
    TerrainNoRegular,
    UnreadableFile,
)
from tms_reason.errors import DbError
from tms_reason.reason import Reason

# The C++ system's names of the types, with its ids and file endings. Dynamic clouds come over ROS, not as files.
# `ground` is ours.
IDS = {"static": 3030, "mesh": 3030, "dem": 3030, "dynamic": 3031, "heightmap": 4031, "texture": 4031, "ground": 4032}
ENDINGS = {"heightmap": ".png", "texture": ".png", "static": ".pcd", "mesh": ".ply", "dem": ".npy"}
IMAGES = ("heightmap", "texture")
FIRST_BYTES = {"mesh": (b"ply\n", b"ply\r\n"), "dem": (b"\x93NUMPY",), "static": (b"# .PCD", b"VERSION", b"#")}
MAX_FILE = 200 * 2**20
MAX_SIDE = 4096  # pixels; a larger answer would stay in the memory of tms:db (measured: 33 MB cost it 100 MB)
PNG = b"\x89PNG\r\n\x1a\n"
COLOUR_TYPES = {0: "grey", 2: "colour", 3: "a palette", 4: "grey with transparency", 6: "colour with transparency"}


@dataclass(frozen=True)
class Size:
    """Where an image lies on the site; metres."""

    width: float
    height: float
    elevation: float  # of the highest possible value of a heightmap above its lowest
    offset_x: float = 0.0
    offset_y: float = 0.0


def bad(what: Reason) -> DbError:
    """The error for terrain that is refused."""
    return DbError(what, "BAD_TERRAIN")


def read(path: Path, type_: str) -> bytes:
    """The content of a file of this type.

    Raises:
        DbError: BAD_TERRAIN; names the file and what is wrong with it.
    """
    if path.suffix.lower() != ENDINGS[type_]:
        raise bad(TerrainEnding(str(path), type_, ENDINGS[type_]))
    if not path.is_file():
        raise bad(TerrainNoRegular(str(path)) if path.exists() else TerrainNoFile(str(path)))
    if path.stat().st_size > MAX_FILE:
        raise bad(TerrainLarge(str(path), path.stat().st_size / 2**20, MAX_FILE / 2**20))
    try:
        data = path.read_bytes()
    except OSError as error:
        raise bad(UnreadableFile(str(path), str(error.strerror))) from error
    if type_ in IMAGES:
        _check_png(path, data, type_)
    elif not data.startswith(FIRST_BYTES[type_]):
        raise bad(TerrainBegins(str(path), ENDINGS[type_]))
    return data


def _check_png(path: Path, data: bytes, type_: str) -> None:
    if not data.startswith(PNG):
        raise bad(NoPng(str(path)))
    at, kind = len(PNG), b""
    while kind != b"IEND":
        head = data[at : at + 8]
        size, kind = struct.unpack(">I4s", head) if len(head) == 8 else (0, b"")
        body, end = data[at + 4 : at + 8 + size], data[at + 8 + size : at + 12 + size]
        if len(end) < 4:
            raise bad(ImageEnds(str(path)))
        if zlib.crc32(body) != int.from_bytes(end, "big"):
            raise bad(ImageDamaged(str(path), at))
        if at == len(PNG):
            _check_pixels(path, kind, body[4:], type_)
        at += 12 + size


def _check_pixels(path: Path, kind: bytes, header: bytes, type_: str) -> None:
    if kind != b"IHDR" or len(header) != 13:
        raise bad(ImageNoHeader(str(path)))
    width, height, depth, colour = struct.unpack(">IIBB", header[:10])
    if not (0 < width <= MAX_SIDE and 0 < height <= MAX_SIDE):
        raise bad(ImageSides(str(path), width, height, MAX_SIDE))
    found = f"{depth}-bit {COLOUR_TYPES.get(colour, 'of an unknown kind')}"
    if type_ == "heightmap" and (colour != 0 or depth not in (8, 16)):
        raise bad(NoHeightPixels(str(path), found))
    if type_ == "texture" and (colour not in (0, 2, 6) or depth != 8):
        raise bad(NoColourPixels(str(path), found))
