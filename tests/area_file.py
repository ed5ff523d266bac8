"""The areas of a test's site, in a file where the site looks for them."""

import json
from collections.abc import Mapping, Sequence

from conftest import CLI, Mesh, wait_until

Areas = Mapping[str, tuple[str, Sequence[Sequence[float]]]]  # by name: type, and corners in `map` [m]
ENABLE = ("areas", "enable", "--yes", "--by", "a person")


def write(mesh: Mesh, areas: Areas) -> None:
    """Write them; they count once they are enabled."""
    features = [
        {
            "type": "Feature",
            "properties": {"id": name, "type": kind},
            "geometry": {"type": "Polygon", "coordinates": [[*corners, corners[0]]]},
        }
        for name, (kind, corners) in areas.items()
    ]
    folder = mesh.site.with_suffix("") / "areas"
    folder.mkdir(parents=True, exist_ok=True)
    document = {"type": "FeatureCollection", "frame": "map", "features": features}
    (folder / "yard.geojson").write_text(json.dumps(document))


def up(mesh: Mesh, areas: Areas) -> None:
    """Start a mesh with these areas, enable them once its gateways serve, and arm its machines."""
    write(mesh, areas)
    mesh.tms("up", "--no-wait")  # without areas it is not ready
    wait_until(lambda: mesh.tms(*ENABLE, expect=None).returncode == 0, 90, "all gateways serve", every=CLI)
    mesh.arm()
