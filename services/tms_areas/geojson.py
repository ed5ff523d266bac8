"""Areas as GeoJSON (RFC 7946): longitude and latitude by WGS84, or x and y [m] with `"frame": "map"`.

Each feature is a polygon without holes. Its properties: `id`, `type` (see areas.py), and where they apply `name`,
`maximum_speed` [m/s], `on_loss`. What a drawing program adds for itself (`fid`, styles) is refused, as a misspelt
property would be: an area must never mean less than its author thinks.
"""

import json
from collections.abc import Callable, Iterable
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, ValidationError

from tms_areas.areas import Area, AreaSet, Kind, OnLoss, ring
from tms_areas.checks import area_flaw, set_flaw
from tms_areas.reasons import (
    AreaFile,
    AreaFileLarge,
    HasHole,
    NoJson,
    NoOriginForAreas,
    OfArea,
    OtherCoordinates,
    RingOpen,
)
from tms_config.models import Settings
from tms_reason.errors import ConfigError
from tms_reason.reason import Reason
from tms_reason.validation import explain

LARGEST = 2_000_000  # bytes of a file
NAME = r"^[A-Za-z0-9][A-Za-z0-9_.-]{0,63}$"
CRS84 = ("urn:ogc:def:crs:OGC:1.3:CRS84", "urn:ogc:def:crs:OGC::CRS84", "urn:ogc:def:crs:EPSG::4326")

Array = NDArray[np.float64]
ToMap = Callable[[Array, Array], tuple[Array, Array]]  # longitudes and latitudes [deg] to x and y [m]
Position = tuple[float, float] | tuple[float, float, float]  # a height is left out


class _Properties(Settings):
    id: str = Field(pattern=NAME)
    type: Kind
    name: str = Field(max_length=200, default="")
    maximum_speed: float | None = Field(gt=0, le=20, default=None)
    on_loss: OnLoss | None = None


class _Polygon(Settings):
    type: Literal["Polygon"]
    coordinates: tuple[tuple[Position, ...], ...] = Field(min_length=1)
    bbox: tuple[float, ...] = ()


class _Feature(Settings):
    type: Literal["Feature"]
    id: int | str | None = None  # of the drawing program
    properties: _Properties
    geometry: _Polygon
    bbox: tuple[float, ...] = ()


class _CrsName(Settings):
    name: str


class _Crs(Settings):
    """Older writers say with it what RFC 7946 means anyway."""

    type: str = "name"
    properties: _CrsName


class _File(Settings):
    type: Literal["FeatureCollection"]
    frame: Literal["map", "WGS84"] = "WGS84"
    features: tuple[_Feature, ...]
    name: str = ""
    crs: _Crs | None = None
    bbox: tuple[float, ...] = ()


def read(text: str, file: str, to_map: ToMap | None) -> list[Area]:
    """The areas of one file; `to_map`: None where the site does not tell its place on the globe.

    Raises:
        ConfigError: names the file, the area and what is wrong with it.
    """
    try:
        found = _File.model_validate(_json(text, file))
    except ValidationError as error:
        raise _wrong(file, explain(error)) from error
    crs = "" if found.crs is None else found.crs.properties.name
    if crs and (found.frame == "map" or crs not in CRS84):
        raise _wrong(file, OtherCoordinates(crs))
    if found.frame == "map":
        return [_area(one, file, None) for one in found.features]
    if to_map is None:
        raise _wrong(file, NoOriginForAreas())
    return [_area(one, file, to_map) for one in found.features]


def gathered(files: Iterable[list[Area]]) -> AreaSet:
    """One set of the areas of all files.

    Raises:
        ConfigError: together they make no sense.
    """
    found = AreaSet(tuple(sorted((one for areas in files for one in areas), key=lambda one: one.id)))
    flaw = set_flaw(found)
    if flaw is not None:
        raise ConfigError(flaw)
    return found


def written(areas: AreaSet) -> dict[str, Any]:
    """The document of a whole set, in `map`; reading it gives the same set."""
    features = [
        {
            "type": "Feature",
            "properties": one.properties,
            "geometry": {"type": "Polygon", "coordinates": [[*map(list, one.corners), list(one.corners[0])]]},
        }
        for one in areas.areas
    ]
    return {"type": "FeatureCollection", "frame": "map", "features": features}


def _json(text: str, file: str) -> Any:
    if len(text) > LARGEST:
        raise _wrong(file, AreaFileLarge(LARGEST))
    try:
        return json.loads(text)
    except json.JSONDecodeError as error:
        raise _wrong(file, NoJson(error.lineno, error.colno)) from error
    except RecursionError as error:
        raise _wrong(file, NoJson(1, 1)) from error


def _area(feature: _Feature, file: str, to_map: ToMap | None) -> Area:
    told, rings = feature.properties, feature.geometry.coordinates
    if len(rings) > 1:
        raise _wrong(file, OfArea(told.id, HasHole()))
    places = [(float(one[0]), float(one[1])) for one in rings[0]]
    if not places or places[0] != places[-1]:
        raise _wrong(file, OfArea(told.id, RingOpen()))
    if to_map is not None:
        x, y = to_map(*np.array(places, dtype=float).T)
        places = [(float(a), float(b)) for a, b in zip(x, y, strict=True)]
    flaw = area_flaw(told.type, places[:-1], told.maximum_speed, told.on_loss)
    if flaw is not None:
        raise _wrong(file, OfArea(told.id, flaw))
    on_loss = told.on_loss or ("stop" if told.type == "release" else None)
    return Area(told.id, told.type, ring(places[:-1]), told.name, told.maximum_speed, on_loss)


def _wrong(file: str, why: Reason) -> ConfigError:
    return ConfigError(AreaFile(file, why))
