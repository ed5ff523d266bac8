"""Between the frame `map` of a site and coordinates of the world: planes, latitude and longitude, any EPSG code."""

import math
from functools import lru_cache

from pyproj import CRS, Transformer
from pyproj.exceptions import CRSError

from tms_ground.reasons import FrameUnits, FrameUnknown
from tms_ground.settings import Origin
from tms_reason.errors import TmsError
from tms_soil.surface import Array

WGS84 = 4326  # EPSG: latitude and longitude
FIRST_PLANE = 6668  # EPSG of plane n of JGD2011 is this + n
UNITS = {"metre", "degree"}  # names in pyproj


class SiteFrame:
    """Converts places of one site. East comes before north, x before y, longitude before latitude."""

    def __init__(self, origin: Origin) -> None:
        self.origin = origin
        if origin.plane is not None:
            self._base = CRS.from_epsg(FIRST_PLANE + origin.plane)
            self._east, self._north = float(origin.east or 0.0), float(origin.north or 0.0)
        else:
            centre = f"+lat_0={origin.latitude} +lon_0={origin.longitude}"
            self._base = CRS.from_proj4(f"+proj=tmerc {centre} +k=1 +x_0=0 +y_0=0 +datum=WGS84 +units=m")
            self._east = self._north = 0.0
        self._cos, self._sin = math.cos(origin.yaw), math.sin(origin.yaw)

    def to_map(self, x: Array, y: Array, epsg: int) -> tuple[Array, Array]:
        """X and y [m] in `map` of places in other coordinates [m or deg].

        Raises:
            TmsError: nobody knows the code, or its unit is neither metre nor degree.
        """
        east, north = _transformer(crs(epsg), self._base).transform(x, y)
        right, up = east - self._east, north - self._north
        return right * self._cos + up * self._sin, up * self._cos - right * self._sin

    def from_map(self, x: Array, y: Array, epsg: int) -> tuple[Array, Array]:
        """The reverse of `to_map`."""
        east = self._east + x * self._cos - y * self._sin
        north = self._north + x * self._sin + y * self._cos
        there: tuple[Array, Array] = _transformer(self._base, crs(epsg)).transform(east, north)
        return there


@lru_cache
def crs(epsg: int) -> CRS:
    """A system of coordinates by its code.

    Raises:
        TmsError: nobody knows the code, or its unit is neither metre nor degree.
    """
    try:
        found = CRS.from_epsg(epsg)
    except CRSError as error:
        raise TmsError(FrameUnknown(epsg)) from error
    unit = found.axis_info[0].unit_name if found.axis_info else "none"
    if unit not in UNITS:
        raise TmsError(FrameUnits(epsg, unit))
    return found


@lru_cache
def _transformer(source: CRS, target: CRS) -> Transformer:
    return Transformer.from_crs(source, target, always_xy=True)
