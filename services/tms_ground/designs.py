"""The design of a site: the surface that its ground should become, from the site file."""

from tms_config.config import Site
from tms_config.yaml_file import located
from tms_ground.settings import Ground
from tms_reason.errors import ConfigError, TmsError
from tms_soil.surface import Pit, Plane, Surface


def surface_of(site: Site, ground: Ground) -> Surface | None:
    """The design of a site; None where its file tells none.

    Raises:
        ConfigError: its file cannot be read, or is not fit.
    """
    told = ground.design
    if told is None:
        return None
    if told.plane is not None:
        return Plane(told.plane.z, told.plane.slope_x, told.plane.slope_y)
    if told.pit is not None:
        return Pit(told.pit.floor, told.pit.level, told.pit.slope, told.pit.rim)
    assert told.file is not None
    from tms_ground.files.reading import Given, read  # here: their libraries take a third of a start of tms:ground
    from tms_ground.frame import SiteFrame

    frame = SiteFrame(ground.origin) if ground.origin is not None else None
    given = Given(told.file.in_map, told.file.epsg, None, told.file.surface, partial=True)
    try:
        return read(site.path.parent / told.file.path, ground.area, ground.cell, frame, given)
    except TmsError as error:
        raise ConfigError(located(site.path, error.reason, "ground", "design", "file")) from error
