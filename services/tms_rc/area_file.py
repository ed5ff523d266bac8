"""The enabled areas of a machine, on the disk of its PC: the law holds with every other process dead.

`<state>/rc/<machine>.areas` is the set with its id, who enabled it, and when. A file that does not fit its id, or
that cannot be read, is none: the machine is not ready until a person enables areas again.
"""

import json
from dataclasses import dataclass
from pathlib import Path

from tms_areas.areas import AreaSet
from tms_areas.geojson import gathered, read, written
from tms_rc.area_path import area_path
from tms_rc.reasons import AreasNotEnabled, AreasUnreadable
from tms_reason.errors import ConfigError, TmsError
from tms_runtime import durable


@dataclass(frozen=True)
class Enabled:
    """A set of areas that a person has enabled."""

    areas: AreaSet
    who: str
    at: float  # s since 1970


class AreaFile:
    """The file of one machine."""

    def __init__(self, state: Path, machine: str) -> None:
        self._path = area_path(state, machine)

    def read(self) -> Enabled:
        """The areas that are enabled.

        Raises:
            TmsError: none are, or it is not known which.
        """
        try:
            found = json.loads(self._path.read_text(encoding="utf-8"))
            areas = gathered([read(json.dumps(found["areas"]), self._path.name, None)])
            enabled = Enabled(areas, str(found["who"]), float(found["at"]))
        except FileNotFoundError as error:
            raise TmsError(AreasNotEnabled()) from error
        except (OSError, ValueError, KeyError, TypeError, ConfigError) as error:
            raise TmsError(AreasUnreadable()) from error
        if areas.id != found.get("id"):
            raise TmsError(AreasUnreadable())
        return enabled

    def keep(self, enabled: Enabled) -> None:
        """Write the areas, whole, before they count.

        Raises:
            OSError: they could not be written; those before still count.
        """
        areas = enabled.areas
        found = {"id": areas.id, "who": enabled.who, "at": enabled.at, "areas": written(areas)}
        durable.replace(self._path, json.dumps(found, ensure_ascii=False).encode())
