"""`ground:` of a site file: what is wrong is told with its line and key."""

from pathlib import Path

import numpy as np
import pytest

import height_files as files
from tms_config.config import load_site
from tms_config.processes import table
from tms_config.reasons import BadKey
from tms_ground.designs import surface_of
from tms_ground.reasons import AreaInsideOut, GroundFile, NoGround, NoSoil, OneDesign, WhereIsOrigin
from tms_ground.settings import ground_of, needed, soils_of
from tms_reason.errors import ConfigError
from tms_reason.reason import Reason

PLANE = "plane: 9, north: -36000.5, east: -7000"


def site(folder: Path, ground: str = ""):
    path = folder / "site.yaml"
    path.write_text(f"name: t\ndomain: 43\nservices: {{db: {{}}}}\n{ground}")
    return load_site(str(path))


def refused(folder: Path, ground: str) -> Reason:
    with pytest.raises(ConfigError) as caught:
        ground_of(site(folder, ground))
    return caught.value.reason


def test_a_whole_ground(tmp_path: Path) -> None:
    found = needed(site(tmp_path, f"ground:\n  origin: {{{PLANE}, height: 12.5}}\n  area: [0, 0, 40, 30]\n"
                                  "  plan: {bank: 300, loads: 50}\n"))  # fmt: skip
    assert found.origin is not None and found.plan is not None
    assert (found.origin.plane, found.origin.height, found.area, found.cell) == (9, 12.5, (0, 0, 40, 30), 0.2)
    assert (found.plan.bank, found.plan.loads) == (300, 50)
    assert ground_of(site(tmp_path, "ground: {area: [0, 0, 1, 1], origin: {latitude: 36, longitude: 140}}")) is not None


def test_a_site_without_one(tmp_path: Path) -> None:
    assert ground_of(site(tmp_path)) is None
    with pytest.raises(ConfigError) as caught:
        needed(site(tmp_path))
    assert caught.value.reason.find(NoGround) is not None


@pytest.mark.parametrize("origin", [
    "plane: 9", "latitude: 36", "height: 3", f"{PLANE}, latitude: 36, longitude: 140", f"{PLANE}, latitude: 36",
])  # fmt: skip
def test_half_an_origin_and_two(tmp_path: Path, origin: str) -> None:
    found = refused(tmp_path, f"ground:\n  area: [0, 0, 1, 1]\n  origin: {{{origin}}}\n")
    assert isinstance(found, BadKey) and (found.line, found.key) == (6, "ground.origin")
    assert found.find(WhereIsOrigin) is not None


@pytest.mark.parametrize("area", ["[4, 0, 0, 3]", "[0, 0, 4, 0]"])
def test_an_area_without_size(tmp_path: Path, area: str) -> None:
    assert refused(tmp_path, f"ground: {{area: {area}}}").find(AreaInsideOut) is not None


def test_a_plane_that_japan_does_not_have(tmp_path: Path) -> None:
    found = refused(tmp_path, "ground: {area: [0, 0, 1, 1], origin: {plane: 20, north: 0, east: 0}}")
    assert isinstance(found, BadKey) and found.key == "ground.origin.plane"


def test_its_soil_is_one_of_the_known_ones(tmp_path: Path) -> None:
    chosen = site(tmp_path, "ground: {area: [0, 0, 1, 1], soil: clay}")
    assert [one.cohesion for one in soils_of(chosen, needed(chosen)).values()] == [40000]
    chosen = site(tmp_path, "ground: {area: [0, 0, 1, 1], soil: cheese}")
    with pytest.raises(ConfigError) as caught:
        soils_of(chosen, needed(chosen))
    found = caught.value.reason
    assert isinstance(found, BadKey) and found.key == "ground.soil"
    assert isinstance(found.problem, NoSoil) and "earth" in found.problem.soils


PIT = "pit: {floor: [[0, 0], [9, 0], [9, 9]], level: -2, rim: 0}"


def test_a_design_is_a_plane_a_pit_or_a_file(tmp_path: Path) -> None:
    files.landxml(tmp_path / "pit.xml")
    for told, level in (("plane: {z: 1.5, slope_x: 0.1}", 1.9), (PIT, -2.0)):
        chosen = site(tmp_path, f"ground: {{area: [0, 0, 20, 10], design: {{{told}}}}}")
        found = surface_of(chosen, needed(chosen))
        assert found is not None and found.at(np.array([4.0]), np.array([2.0])) == pytest.approx(level)
    origin = f"origin: {{plane: 9, north: {files.NORTH}, east: {files.EAST}, height: {files.LEVEL}}}"
    told = f"ground: {{area: [0, 0, 20, 10], {origin}, design: {{file: {{path: PATH, epsg: 6677}}}}}}"
    chosen = site(tmp_path, told.replace("PATH", "pit.xml"))
    found, (x, y) = surface_of(chosen, needed(chosen)), (np.array([4.0]), np.array([2.0]))
    assert found is not None and found.at(x, y) == pytest.approx(files.height(x, y), abs=1e-3)
    chosen = site(tmp_path, told.replace("PATH", "none.xml"))
    with pytest.raises(ConfigError) as caught:
        surface_of(chosen, needed(chosen))
    reason = caught.value.reason
    assert isinstance(reason, BadKey) and reason.key == "ground.design.file" and reason.find(GroundFile) is not None
    chosen = site(tmp_path, "ground: {area: [0, 0, 20, 10]}")
    assert surface_of(chosen, needed(chosen)) is None


@pytest.mark.parametrize("design", ["{}", f"{{{PIT}, plane: {{z: 1}}}}"])
def test_no_design_and_two(tmp_path: Path, design: str) -> None:
    assert refused(tmp_path, f"ground: {{area: [0, 0, 1, 1], design: {design}}}").find(OneDesign) is not None


def test_soils_by_region(tmp_path: Path) -> None:
    region = "{{soil: {}, corners: [[0, 0], [30, 0], [30, 30], [0, 30]]}}"
    told = "ground: {{area: [-30, -30, 30, 30], soils: [{}, {}, {}]}}"
    names = [region.format(name) for name in ("sand", "clay", "earth")]
    chosen = site(tmp_path, told.format(*names))
    assert list(soils_of(chosen, needed(chosen))) == ["earth", "sand", "clay"]
    chosen = site(tmp_path, told.format(names[0], names[1], region.format("cheese")))
    with pytest.raises(ConfigError) as caught:
        soils_of(chosen, needed(chosen))
    assert isinstance(caught.value.reason, BadKey) and caught.value.reason.key == "ground.soils.2.soil"


def test_only_a_site_with_a_ground_has_the_process(tmp_path: Path) -> None:
    assert "tms:ground" not in [row.full for row in table(site(tmp_path))]
    assert "tms:ground" in [row.full for row in table(site(tmp_path, "ground: {area: [0, 0, 1, 1]}"))]
