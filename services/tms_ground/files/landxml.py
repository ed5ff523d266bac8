"""Surfaces of LandXML 1.2 and of J-LandXML (MLIT): points and faces of a TIN only.

A point is `north east height`. A face with `i="1"` is not part of the surface. J-LandXML tells its plane as
horizontalCoordinateSystemName="9(X,Y)", others tell an epsgCode.
"""

import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from lxml import etree

from tms_ground.files.samples import refuse_large
from tms_ground.files.triangles import Triangles
from tms_ground.frame import FIRST_PLANE
from tms_ground.reasons import (
    FaceUnreadable,
    LengthUnit,
    ManySurfaces,
    NoSurface,
    PointUnreadable,
    SurfaceUnknown,
    XmlUnreadable,
)
from tms_reason.errors import TmsError

PLANE = re.compile(r"\s*(\d{1,2})\s*\(X,\s*Y\)\s*")
METRES = {"meter", "metre"}


@dataclass
class _Surface:
    """A surface while it is read; numbers of points are the file's own."""

    points: dict[str, tuple[float, float, float]] = field(default_factory=dict)  # east, north, height
    faces: list[tuple[str, str, str]] = field(default_factory=list)


def read(path: Path, name: str | None = None) -> Triangles:
    """A surface of a file; `name` is needed where it holds several.

    Raises:
        TmsError: it is damaged, not in metres, or holds no such surface.
    """
    refuse_large(path)
    reading = _Reading()
    try:
        with path.open("rb") as file:
            for _, element in etree.iterparse(
                file, events=("end",), resolve_entities=False, no_network=True, huge_tree=True
            ):
                reading.take(element)
    except etree.XMLSyntaxError as error:
        raise TmsError(XmlUnreadable(str(error.msg))) from error
    return _triangles(reading.chosen(name), reading.epsg)


class _Reading:
    """Takes the elements of a file as they end, and forgets each, so that a large file needs little memory."""

    def __init__(self) -> None:
        self.epsg: int | None = None
        self._surfaces: dict[str, _Surface] = {}
        self._now = _Surface()

    def take(self, element: Any) -> None:
        """One element with all that is in it."""
        kind = etree.QName(element).localname if isinstance(element.tag, str) else ""
        if kind == "P":
            self._now.points[element.get("id", "")] = _point(element)
        elif kind == "F" and element.get("i") != "1":
            self._now.faces.append(_face(element))
        elif kind == "Surface":
            if self._now.faces:
                self._surfaces[element.get("name") or str(len(self._surfaces) + 1)] = self._now
            self._now = _Surface()
        elif kind in ("Metric", "Imperial"):
            unit = element.get("linearUnit", "")
            if unit.lower() not in METRES:
                raise TmsError(LengthUnit(unit))
        elif kind == "CoordinateSystem":
            self.epsg = _epsg(element)
        if kind in ("P", "F", "Surface"):
            element.clear()

    def chosen(self, name: str | None) -> _Surface:
        """The surface of a name, or the only one."""
        names = tuple(self._surfaces)
        if not names:
            raise TmsError(NoSurface())
        if name is not None and name not in names:
            raise TmsError(SurfaceUnknown(name, names))
        if name is None and len(names) > 1:
            raise TmsError(ManySurfaces(names))
        return self._surfaces[name or names[0]]


def _point(element: Any) -> tuple[float, float, float]:
    words = (element.text or "").split()
    try:
        north, east, height = (float(word) for word in words)
    except ValueError as error:
        raise TmsError(PointUnreadable(element.sourceline or 0, " ".join(words)[:60])) from error
    if not np.isfinite([north, east, height]).all():
        raise TmsError(PointUnreadable(element.sourceline or 0, " ".join(words)[:60]))
    return east, north, height


def _face(element: Any) -> tuple[str, str, str]:
    words = (element.text or "").split()
    if len(words) != 3:
        raise TmsError(FaceUnreadable(element.sourceline or 0, " ".join(words)[:60]))
    return words[0], words[1], words[2]


def _epsg(element: Any) -> int | None:
    code = element.get("epsgCode", "").strip()
    plane = PLANE.fullmatch(element.get("horizontalCoordinateSystemName", ""))
    if code.isdecimal():
        return int(code)
    return FIRST_PLANE + int(plane[1]) if plane is not None and 1 <= int(plane[1]) <= 19 else None


def _triangles(surface: _Surface, epsg: int | None) -> Triangles:
    numbers = {name: number for number, name in enumerate(surface.points)}
    try:
        corners = np.array([[numbers[name] for name in face] for face in surface.faces])
    except KeyError as error:
        raise TmsError(FaceUnreadable(0, str(error.args[0]))) from error
    return Triangles(np.array(list(surface.points.values())), corners, epsg)
