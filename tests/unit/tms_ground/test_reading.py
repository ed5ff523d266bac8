"""Each format gives the heights of the plane that was written; each defect is a reason of its own."""

import math
import tracemalloc
from collections.abc import Callable
from pathlib import Path

import laspy
import numpy as np
import pytest
from PIL import Image

import height_files as files
from height_files import EAST, LEVEL, NORTH, height
from tms_ground import reasons
from tms_ground.files import cloud, samples
from tms_ground.files.image import Size
from tms_ground.files.reading import BAD, Given, read
from tms_ground.frame import SiteFrame
from tms_ground.settings import Origin
from tms_reason.errors import TmsError
from tms_reason.reason import Reason
from tms_soil.surface import Heights

AREA = (0.0, 0.0, 20.0, 10.0)  # m
FRAME = SiteFrame(Origin(plane=9, north=NORTH, east=EAST, height=LEVEL))
TOLD = Given(epsg=6677)


def of(path: Path, given: Given = TOLD, frame: SiteFrame | None = FRAME, cell: float = 0.5) -> Heights:
    return read(path, AREA, cell, frame, given)


def refused(path: Path, given: Given = TOLD, frame: SiteFrame | None = FRAME, cell: float = 0.5) -> Reason:
    with pytest.raises(TmsError) as caught:
        of(path, given, frame, cell)
    error = caught.value
    assert isinstance(error.reason, reasons.GroundFile) and error.reason.file == str(path) and error.code == BAD
    return error.reason.why


def is_the_plane(found: Heights, within: float = 1e-4) -> None:
    assert (found.x0, found.y0, found.cell, found.z.shape) == (0.0, 0.0, 0.5, (20, 40))
    assert np.abs(found.z - height(*found.centres)).max() < within


WRITERS: dict[str, Callable[[Path], Path]] = {
    "a.asc": files.ascii_grid,
    "a.tif": files.geotiff,
    "point.tiff": lambda path: files.geotiff(path, point=True),
    "packed.tif": lambda path: files.geotiff(path, compression="tiff_lzw"),
    "a.xml": files.landxml,
    "A.LandXML": files.landxml,
}


@pytest.mark.parametrize("name", WRITERS)
def test_a_plane_comes_back(tmp_path: Path, name: str) -> None:
    is_the_plane(of(WRITERS[name](tmp_path / name)))


@pytest.mark.parametrize("name", ["a.las", "a.laz"])
def test_of_a_cloud_the_ground_counts_and_neither_leaves_nor_noise(tmp_path: Path, name: str) -> None:
    path = files.cloud(tmp_path / name)
    is_the_plane(of(path, Given()), within=0.02)  # the mean of the points in a cell; it tells its coordinates


def test_a_cloud_in_pieces_is_the_same(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = files.cloud(tmp_path / "a.laz")
    whole = of(path)
    monkeypatch.setattr(cloud, "PIECE", 1000)
    assert np.allclose(of(path).z, whole.z, atol=1e-9, equal_nan=True)


def test_a_large_cloud_needs_little_memory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = files.cloud(tmp_path / "a.las", step=0.02)
    assert path.stat().st_size > 70 * 2**20
    monkeypatch.setattr(cloud, "PIECE", 50_000)
    monkeypatch.setattr(samples, "MAX_FILE", 2**20)  # which is for files that are read as a whole
    tracemalloc.start()
    is_the_plane(of(path), within=0.02)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 20 * 2**20


def test_an_image_lies_where_it_is_told(tmp_path: Path) -> None:
    x, y = np.meshgrid(np.arange(40) * 0.5 + 0.25, np.arange(20) * 0.5 + 0.25)
    grey = np.round(height(x, y) / 4.0 * 65535).astype(np.uint16)[::-1]
    Image.fromarray(grey).save(tmp_path / "a.png")
    is_the_plane(of(tmp_path / "a.png", Given(size=Size(20.0, 10.0, 4.0)), None))
    lifted = of(tmp_path / "a.png", Given(size=Size(22.0, 12.0, 4.0, base=3.0, offset_x=-1.0, offset_y=-1.0)), None)
    assert lifted.z[0, 0] == pytest.approx(
        3 + height(0.25 + 1.25 / 22 * 20 - 0.25, 0.25 + 1.25 / 12 * 10 - 0.25), abs=0.02
    )
    Image.fromarray((grey >> 8).astype(np.uint8)).save(tmp_path / "b.png")
    is_the_plane(of(tmp_path / "b.png", Given(size=Size(20.0, 10.0, 4.0))), within=4 / 255 * 2)


def test_a_turned_map_and_other_coordinates(tmp_path: Path) -> None:
    """The map's x axis points north, and the file's coordinates are not those of the origin."""
    frame = SiteFrame(Origin(plane=9, north=NORTH, east=EAST + 10, height=LEVEL, yaw=math.pi / 2))
    found = read(files.ascii_grid(tmp_path / "a.asc"), (0.0, 0.0, 10.0, 10.0), 0.5, frame, TOLD)
    x, y = found.centres
    assert np.abs(found.z - height(10 - y, x)).max() < 1e-4
    by_degrees = SiteFrame(Origin(latitude=35.675, longitude=139.755, height=LEVEL))
    east, north = (float(one[0]) for one in by_degrees.to_map(np.array([EAST]), np.array([NORTH]), 6677))
    area = (east + 1, north + 1, east + 15, north + 9)
    found = read(files.ascii_grid(tmp_path / "b.asc"), area, 0.5, by_degrees, TOLD)
    x, y = found.centres
    assert np.abs(found.z - height(x - east, y - north)).max() < 2e-3  # the scale of the plane, and its convergence


def test_coordinates_that_do_not_fit(tmp_path: Path) -> None:
    asc, tif = files.ascii_grid(tmp_path / "a.asc"), files.geotiff(tmp_path / "a.tif")
    assert refused(asc, Given()) == reasons.FrameNotTold()
    assert refused(asc, Given(epsg=999999)) == reasons.FrameUnknown(999999)
    assert refused(asc, TOLD, None) == reasons.NoOrigin(6677)
    assert refused(tif, Given(epsg=6676)) == reasons.FramesDiffer(6677, "6676")
    assert refused(tif, Given(in_map=True)) == reasons.FramesDiffer(6677, "map")
    assert isinstance(refused(asc, Given(in_map=True)), reasons.NotOnSite)
    assert isinstance(refused(files.geotiff(tmp_path / "b.tif", epsg=2263)), reasons.FramesDiffer)
    assert refused(files.geotiff(tmp_path / "b.tif", epsg=2263), Given()) == reasons.FrameUnits(2263, "US survey foot")


def test_units_that_are_not_metres(tmp_path: Path) -> None:
    assert refused(files.geotiff(tmp_path / "a.tif", unit=9003)) == reasons.LengthUnit("EPSG 9003")
    assert refused(files.landxml(tmp_path / "a.xml", unit="millimeter")) == reasons.LengthUnit("millimeter")
    why = refused(files.cloud(tmp_path / "a.las", height_scale=1000))
    assert isinstance(why, reasons.NotMetres) and why.most > 13_000


def test_holes_and_what_is_not_covered(tmp_path: Path) -> None:
    tif = files.geotiff(tmp_path / "a.tif", hole=-9999)
    why = refused(tif)
    assert isinstance(why, reasons.HasHoles) and (why.unknown, why.whole) == (0.25, 200.0)
    assert (why.x, why.y) == (2.75, 7.25)
    assert np.isnan(of(tif, Given(keep_holes=True)).z).sum() == 1
    grid = files.ascii_grid(tmp_path / "c.asc")
    rows = grid.read_text().splitlines()
    rows[6 + 9] = "-9999 " * 48
    grid.write_text("\n".join(rows))
    why = refused(grid)
    assert isinstance(why, reasons.HasHoles) and (why.unknown, why.y) == (10.0, 7.25)
    nan = files.geotiff(tmp_path / "b.tif", hole=float("nan"))
    assert isinstance(refused(nan), reasons.HasHoles)
    short = files.ascii_grid(tmp_path / "a.asc", xllcorner=EAST + 3)
    why = refused(short)
    assert isinstance(why, reasons.NotOnSite) and why.covered == pytest.approx(85.0)
    assert np.isnan(of(short, Given(epsg=6677, partial=True)).z).sum() == 20 * 6
    assert isinstance(refused(files.ascii_grid(tmp_path / "b.asc", xllcorner=0)), reasons.NotOnSite)
    assert isinstance(refused(files.cloud(tmp_path / "a.laz", step=1.0)), reasons.HasHoles)


def test_files_that_are_not_what_they_seem(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("a.png", "a.tif", "a.asc", "a.las", "a.laz", "a.xml"):
        (tmp_path / name).write_bytes(b"\x89 not what its name says\n" * 20)
        why = refused(tmp_path / name, Given(epsg=6677, size=Size(1, 1, 1) if name == "a.png" else None))
        assert isinstance(why, reasons.GroundFileDamaged | reasons.XmlUnreadable), name
    (tmp_path / "a.shp").write_bytes(b"")
    assert isinstance(refused(tmp_path / "a.shp"), reasons.GroundFileKind)
    assert refused(tmp_path / "none.asc") == reasons.GroundFileMissing()
    assert refused(tmp_path / "a.png") == reasons.ImageNeedsSize()
    Image.new("RGB", (4, 4)).save(tmp_path / "c.png")
    assert refused(tmp_path / "c.png", Given(size=Size(1, 1, 1))) == reasons.ImageNotGrey("RGB")
    assert isinstance(refused(files.ascii_grid(tmp_path / "b.asc"), cell=0.001), reasons.ManyCells)
    monkeypatch.setattr(samples, "MAX_PIXELS", 1000)
    assert refused(files.geotiff(tmp_path / "b.tif")) == reasons.ManyPixels(48, 28, 1000)
    Image.new("L", (30, 40)).save(tmp_path / "d.png")
    assert refused(tmp_path / "d.png", Given(size=Size(1, 1, 1))) == reasons.ManyPixels(30, 40, 1000)
    monkeypatch.setattr(samples, "MAX_FILE", 1000)
    assert isinstance(refused(files.ascii_grid(tmp_path / "b.asc")), reasons.GroundFileLarge)


def test_files_that_end_early(tmp_path: Path) -> None:
    for path in (files.geotiff(tmp_path / "a.tif"), files.cloud(tmp_path / "a.laz"), files.landxml(tmp_path / "a.xml")):
        path.write_bytes(path.read_bytes()[: path.stat().st_size * 2 // 3])
        assert isinstance(refused(path), reasons.GroundFileDamaged | reasons.XmlUnreadable), path


def test_clouds_that_tell_of_more_than_they_hold(tmp_path: Path) -> None:
    las = files.cloud(tmp_path / "a.las")
    data = las.read_bytes()
    las.write_bytes(data[:-60])  # the last two points
    why = refused(las)
    assert isinstance(why, reasons.CloudEndsEarly) and why.count == 3 * 97 * 57
    las.write_bytes(data[:100] + b"\xff" * 4 + data[104:])  # four billion records before the points
    assert isinstance(refused(las), reasons.GroundFileDamaged)
    laz = files.cloud(tmp_path / "a.laz")
    data = laz.read_bytes()
    points = int.from_bytes(data[96:100], "little")
    table = int.from_bytes(data[points : points + 8], "little")
    laz.write_bytes(data[: table + 4] + b"\xff" * 4 + data[table + 8 :])  # as many compressed pieces
    assert isinstance(refused(laz), reasons.GroundFileDamaged)


def test_grids_with_a_wrong_head(tmp_path: Path) -> None:
    path = tmp_path / "a.asc"
    assert refused(files.ascii_grid(path, nrows=29)) == reasons.GridSize(28, 48, 29, 48)
    assert refused(files.ascii_grid(path, cellsize=None)) == reasons.GridKeyMissing("cellsize")
    assert refused(files.ascii_grid(path, yllcorner=None)) == reasons.GridKeyMissing("yllcorner")
    assert refused(files.ascii_grid(path, cellsize=-1)) == reasons.GridKeyValue("cellsize", "-1.0")
    assert refused(files.ascii_grid(path, ncols="nan")) == reasons.GridKeyValue("ncols", "nan")
    text = files.ascii_grid(path).read_text()
    path.write_text(text.replace("13.", "13,", 1))
    assert isinstance(refused(path), reasons.GroundFileDamaged)


def test_tiffs_that_tell_too_little(tmp_path: Path) -> None:
    assert refused(files.geotiff(tmp_path / "a.tif", scale=False)) == reasons.TiffNotPlaced()
    assert refused(files.geotiff(tmp_path / "a.tif", epsg=32767), Given()) == reasons.FrameNotTold()
    Image.new("RGB", (4, 4)).save(tmp_path / "b.tif")
    assert refused(tmp_path / "b.tif") == reasons.TiffBands("RGB")


def test_a_tiff_that_is_placed_by_a_transformation(tmp_path: Path) -> None:
    x, y = np.meshgrid(np.arange(48) * 0.5 - 1.75, np.arange(28) * 0.5 - 1.75)
    z, keys = height(x, y) + LEVEL, {1024: 1, 1025: 1, 3072: 6677}
    straight = (0.5, 0.0, 0.0, EAST - 2, 0.0, -0.5, 0.0, NORTH + 12, *[0.0] * 7, 1.0)
    is_the_plane(of(files.tiff(tmp_path / "a.tif", z, keys, {34264: straight})))
    turned = (0.5, 0.1, *straight[2:])
    assert refused(files.tiff(tmp_path / "b.tif", z, keys, {34264: turned})) == reasons.TiffTurned()


def test_an_empty_cloud_and_one_without_coordinates(tmp_path: Path) -> None:
    laspy.LasData(laspy.LasHeader(point_format=6, version="1.4")).write(tmp_path / "a.las")
    assert refused(tmp_path / "a.las") == reasons.CloudEmpty()
    assert refused(files.cloud(tmp_path / "b.las", epsg=None), Given()) == reasons.FrameNotTold()
    is_the_plane(of(tmp_path / "b.las"), within=0.02)


def test_a_cloud_that_tells_of_its_heights_too(tmp_path: Path) -> None:
    is_the_plane(of(files.cloud(tmp_path / "a.las", epsg="EPSG:6677+6695"), Given()), within=0.02)
    assert refused(files.cloud(tmp_path / "b.las", epsg="EPSG:6677+6360")) == reasons.LengthUnit("US survey foot")


def test_a_raster_in_degrees(tmp_path: Path) -> None:
    """As the survey authority's elevation models are."""
    longitude, latitude = 139.7560, 35.6752  # its lower left corner, beyond that of the area
    columns, rows = np.meshgrid(np.arange(400), np.arange(300))
    east, north = longitude + (columns + 0.5) * 1e-6, latitude + (rows + 0.5) * 1e-6
    frame = SiteFrame(Origin(latitude=latitude + 5e-5, longitude=longitude + 5e-5, height=LEVEL))
    z = height(*frame.to_map(east, north, 6668)) + LEVEL
    tags = {33550: (1e-6, 1e-6, 0.0), 33922: (0.0, 0.0, 0.0, longitude, latitude + 300e-6, 0.0)}
    path = files.tiff(tmp_path / "a.tif", z, {1024: 2, 1025: 1, 2048: 6668}, tags)
    is_the_plane(read(path, AREA, 0.5, frame, Given()))


def test_surfaces_of_landxml(tmp_path: Path) -> None:
    path = tmp_path / "a.xml"
    assert refused(files.landxml(path, surfaces="")) == reasons.NoSurface()
    assert refused(files.landxml(path, system=""), Given()) == reasons.FrameNotTold()
    is_the_plane(of(files.landxml(path, system='epsgCode="6677"'), Given()))
    assert refused(files.landxml(path), Given(epsg=6677, surface="Top")) == reasons.SurfaceUnknown("Top", ("Design",))
    text = files.landxml(path).read_text()
    begin, end = text.index("<Surface "), text.index("</Surfaces>")
    path.write_text(
        text[:end] + text[begin:end].replace('"Design"', '"Top"').replace("<F>10 12 13</F>", "") + text[end:]
    )
    assert refused(path) == reasons.ManySurfaces(("Design", "Top"))
    is_the_plane(of(path, Given(epsg=6677, surface="Design")))
    assert isinstance(refused(path, Given(surface="Top")), reasons.HasHoles)  # half of it


@pytest.mark.parametrize("point", ["1 2", "1 2 x", "1 2 NaN", "1 2 3 4", ""])
def test_points_of_landxml_that_are_none(tmp_path: Path, point: str) -> None:
    path = files.landxml(tmp_path / "a.xml", points=f'<P id="10">{point}</P>')
    assert refused(path) == reasons.PointUnreadable(5, point)


@pytest.mark.parametrize("face", ["10 11", "10 11 12 13", "10 11 99"])
def test_triangles_of_landxml_that_are_none(tmp_path: Path, face: str) -> None:
    assert isinstance(refused(files.landxml(tmp_path / "a.xml", faces=f"<F>{face}</F>")), reasons.FaceUnreadable)


def test_entities_of_xml_are_not_followed(tmp_path: Path) -> None:
    path = files.landxml(tmp_path / "a.xml", points='<P id="10">&e; 2 3</P>')
    (tmp_path / "secret").write_text("1")
    kind = f'<!DOCTYPE LandXML [<!ENTITY e SYSTEM "{tmp_path / "secret"}">]>'
    path.write_text(path.read_text().replace("<LandXML", kind + "<LandXML", 1))
    assert isinstance(refused(path), reasons.PointUnreadable | reasons.XmlUnreadable)
