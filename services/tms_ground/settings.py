"""Model of `ground:` in a site file: where the site is, which area its ground covers, what is planned for a day."""

from pydantic import Field, ValidationError, model_validator

from tms_config.config import CONFIGS, Site
from tms_config.models import Settings
from tms_config.reasons import BadConfig
from tms_config.yaml_file import located, parse
from tms_ground.reasons import AreaInsideOut, NoGround, NoSoil, OneDesign, WhereIsOrigin
from tms_reason.errors import ConfigError
from tms_reason.validation import Wrong, problems
from tms_soil.soils import Soil, SoilsFile
from tms_work.plan import Plan


class Origin(Settings):
    """The place of the origin of `map`: in Japan's plane rectangular coordinates, or as latitude and longitude.

    With a plane, x and y of `map` are metres on that plane (0.9999 to 1.0001 of the metres on the ground). With
    latitude and longitude they are metres on a transverse Mercator plane whose centre is the origin. WGS84 and JGD2011
    count as one: they differ by the motion of the ground since 2011, up to a few decimetres.
    """

    plane: int | None = Field(ge=1, le=19, default=None)  # number of the plane (kei): EPSG 6668 + number
    north: float | None = None  # m, X of the plane
    east: float | None = None  # m, Y of the plane
    latitude: float | None = Field(ge=-80, le=84, default=None)  # deg, WGS84
    longitude: float | None = Field(ge=-180, le=180, default=None)  # deg, WGS84
    height: float = 0.0  # m, of z = 0 in `map`, in the heights of the site's files
    yaw: float = 0.0  # rad, from east to the x axis of `map`, counter-clockwise

    @model_validator(mode="after")
    def _one_place(self) -> "Origin":
        plane, globe = (self.plane, self.north, self.east), (self.latitude, self.longitude)
        given = [place for place in (plane, globe) if any(value is not None for value in place)]
        if len(given) != 1 or None in given[0]:
            raise Wrong(WhereIsOrigin())
        return self


class SoilRegion(Settings):
    """Where another soil lies: in each tile of 12.8 m whose middle is in a polygon."""

    soil: str  # one of configs/soils.yaml
    corners: tuple[tuple[float, float], ...] = Field(min_length=3)  # m, map


class PlaneDesign(Settings):
    """A level or sloping plane."""

    z: float  # m, map, at its origin
    slope_x: float = 0.0  # rise per length along x
    slope_y: float = 0.0  # rise per length along y


class PitDesign(Settings):
    """A pit: a level floor, slopes up to the rim."""

    floor: tuple[tuple[float, float], ...] = Field(min_length=3)  # m, map: corners
    level: float  # m, map
    rim: float  # m, map: height at which the slopes end
    slope: float = Field(gt=0, default=1.0)  # rise per length


class FileDesign(Settings):
    """A surface in a file (LandXML, GeoTIFF, ASCII grid)."""

    path: str = Field(min_length=1)  # from the folder of the site file
    surface: str | None = None  # its name, where a LandXML holds several
    epsg: int | None = None  # code of its coordinates, where it does not tell them
    in_map: bool = False  # its coordinates are those of `map`


class Design(Settings):
    """The surface that the ground should become, told in one of these ways."""

    plane: PlaneDesign | None = None
    pit: PitDesign | None = None
    file: FileDesign | None = None

    @model_validator(mode="after")
    def _one_surface(self) -> "Design":
        if [self.plane, self.pit, self.file].count(None) != 2:
            raise Wrong(OneDesign())
        return self


class Ground(Settings):
    """The ground of a site."""

    origin: Origin | None = None  # absent: only files in `map` can be read
    area: tuple[float, float, float, float]  # m, map: least x, least y, largest x, largest y
    cell: float = Field(gt=0.01, le=10, default=0.2)  # m, side of the cells of a ground that is imported
    level: float = 0.0  # m, map: height of the ground where `tms:ground` begins
    soil: str = "earth"  # one of configs/soils.yaml
    soils: tuple[SoilRegion, ...] = ()  # the last one counts where several overlap
    plan: Plan | None = None
    design: Design | None = None

    @model_validator(mode="after")
    def _has_area(self) -> "Ground":
        x0, y0, x1, y1 = self.area
        if not (x0 < x1 and y0 < y1):
            raise Wrong(AreaInsideOut(), "area")
        return self


def ground_of(site: Site) -> Ground | None:
    """The ground of a site; None where its file has none.

    Raises:
        ConfigError: names the file, the line and the key.
    """
    if site.file.ground is None:
        return None
    try:
        return Ground.model_validate(site.file.ground)
    except ValidationError as error:
        found = [located(site.path, reason, "ground", *keys) for keys, reason in problems(error)]
        raise ConfigError(found[0] if len(found) == 1 else BadConfig(tuple(found))) from error


def soils_of(site: Site, ground: Ground) -> dict[str, Soil]:
    """The soils of a site by their names, that of its most part first.

    Raises:
        ConfigError: configs/soils.yaml is wrong, or has no such soil.
    """
    known = parse(CONFIGS / "soils.yaml", SoilsFile).soils
    named = [(ground.soil, ("soil",)), *((one.soil, ("soils", k, "soil")) for k, one in enumerate(ground.soils))]
    for name, keys in named:
        if name not in known:
            raise ConfigError(located(site.path, NoSoil(name, tuple(known)), "ground", *keys))
    return {name: known[name] for name, _ in named}


def needed(site: Site) -> Ground:
    """The ground of a site that must have one.

    Raises:
        ConfigError: as `ground_of`, or the site has none.
    """
    found = ground_of(site)
    if found is None:
        raise ConfigError(located(site.path, NoGround()))
    return found
