"""What the verbs of `tms areas` share: the areas of the site's files and of its gateways, and how they differ."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from tms_cli import session
from tms_cli.reasons import AreaFileUnread, NoAreas
from tms_cli.words import padded, say
from tms_config.config import Site
from tms_reason.errors import RosError, TmsError
from tms_ur import gateway_areas

if TYPE_CHECKING:
    from tms_areas.areas import Area, AreaSet
    from tms_areas.geojson import ToMap
    from tms_ros.node import Ros


def configured(site: Site) -> "AreaSet":
    """The areas of the site's files.

    Raises:
        TmsError: there are none, or one of them is wrong.
    """
    from tms_areas.geojson import gathered

    if not site.area_files:
        raise TmsError(NoAreas(str(site.area_folder)))
    return gathered([of_file(site, path) for path in site.area_files])


def of_file(site: Site, path: Path) -> "list[Area]":
    """The areas of one file, in `map`."""
    from tms_areas.geojson import read

    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise TmsError(AreaFileUnread(str(path), str(error)), "NO_FILE") from error
    return read(text, path.name, _to_map(site))


def _to_map(site: Site) -> "ToMap | None":
    from tms_ground.frame import WGS84, SiteFrame
    from tms_ground.settings import ground_of

    ground = ground_of(site)
    if ground is None or ground.origin is None:
        return None
    frame = SiteFrame(ground.origin)
    return lambda longitude, latitude: frame.to_map(longitude, latitude, WGS84)


# gateways


def enabled(node: "Ros", machine: str) -> "tuple[str, AreaSet | None]":
    """Who enabled the areas of a machine, and these; None where none are.

    Raises:
        TmsError: its gateway does not answer.
    """
    from rcl_interfaces.srv import GetParameters

    from tms_areas.geojson import gathered, read

    request = GetParameters.Request(names=["who", "areas"])
    try:
        who, areas = node.call(GetParameters, f"/{machine}/rc/areas/get", request, gateway_areas.LIMIT).values
    except RosError as error:
        raise gateway_areas.not_reached(machine, error) from error
    if not areas.string_value:
        return "", None
    return who.string_value, gathered([read(areas.string_value, machine, None)])


def as_dict(one: "Area") -> dict[str, Any]:
    """An area for --json."""
    return {**one.properties, "area_m2": round(one.polygon.area, 1), "corners": [list(at) for at in one.corners]}


def kind(word: str) -> str:
    """The type of an area, or of a change, for people."""
    return {
        "unmanned": say("unmanned"), "restricted": say("restricted"), "manned": say("manned"),
        "blocked": say("blocked"), "release": say("release"), "speed_limit": say("speed_limit"),
        "added": say("added"), "removed": say("removed"), "changed": say("changed"),
    }[word]  # fmt: skip


def show(areas: "AreaSet") -> list[str]:
    """Lines for people."""
    lines = [say("set {id}", id=areas.id[:12])]
    for one in areas.areas:
        more = f" {one.speed:g} m/s" if one.speed is not None else ""
        more += f" ({one.name})" if one.name else ""
        lines.append(f"  {padded(one.id, 16)} {padded(kind(one.kind), 14)} {one.polygon.area:10.1f} m²{more}")
    return lines


def machines() -> list[str]:
    """The machines whose gateways keep the areas: all of the site."""
    return list(session.site().file.machines)
