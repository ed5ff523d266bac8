"""Terrain files: what is stored comes back, what nobody could read is refused; images as ROS messages."""

import io
import json
import struct
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner, Result
from PIL import Image
from sensor_msgs.msg import PointCloud2, PointField

from tms_cli.commands import terrain as verb
from tms_db import store, terrain_files, terrain_messages
from tms_db.terrain import NEWEST_KEPT, Terrain
from tms_db.terrain_files import Size
from tms_reason.errors import DbError

SIZE = Size(120.0, 80.0, 14.0, -24.0, 12.0)
HEIGHTS = np.arange(60 * 40, dtype=np.uint16).reshape(40, 60) * 27


def png(pixels: Any) -> bytes:
    out = io.BytesIO()
    Image.fromarray(pixels).save(out, "PNG")
    return out.getvalue()


def header(width: int, height: int, depth: int, colour: int) -> bytes:
    """A PNG that has a header and an end only."""
    parts = [(b"IHDR", struct.pack(">IIBBBBB", width, height, depth, colour, 0, 0, 0)), (b"IEND", b"")]
    chunks = [
        struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body)) for kind, body in parts
    ]
    return terrain_files.PNG + b"".join(chunks)


@pytest.fixture
def yard(tmp_path: Path) -> Path:
    path = tmp_path / "yard.png"
    path.write_bytes(png(HEIGHTS))
    return path


def refusal(call: Callable[[], Any]) -> tuple[str, str]:
    with pytest.raises(DbError) as caught:
        call()
    assert "\n" not in str(caught.value)
    return caught.value.code, str(caught.value)


def test_a_heightmap_comes_back_with_its_sizes(shared_db: store.Db, yard: Path) -> None:
    terrain = Terrain(shared_db)
    terrain.add(yard, "heightmap", SIZE)
    found = terrain.find("heightmap")
    assert found is not None
    assert (found.filename, found.id, found.size("width"), found.size("offset_y")) == ("yard.png", 4031, 120.0, 12.0)
    assert terrain.read(found) == yard.read_bytes()
    document = shared_db["fs.files"].find_one({"filename": "yard.png"}) or {}
    assert (document["type"], document["id"], document["elevation"]) == ("heightmap", 4031, 14.0)  # as the C++ system
    message = terrain_messages.image("yard.png", terrain.read(found))
    assert (message.width, message.height, message.encoding, message.step) == (60, 40, "mono16", 120)
    assert np.array_equal(np.frombuffer(message.data, "<u2").reshape(40, 60), HEIGHTS)
    assert refusal(lambda: terrain.add(yard, "heightmap", SIZE))[0] == "TERRAIN_EXISTS"
    assert terrain.remove("yard.png") == 1
    assert shared_db["fs.chunks"].count_documents({}) == 0
    assert refusal(lambda: terrain.remove("yard.png"))[0] == "TERRAIN_MISSING"
    assert refusal(lambda: terrain.remove(""))[0] == "TERRAIN_MISSING"


@pytest.mark.parametrize(("bands", "encoding"), [(3, "rgb8"), (4, "rgba8")])
def test_a_colour_image_as_a_message(shared_db: store.Db, tmp_path: Path, bands: int, encoding: str) -> None:
    pixels = np.arange(20 * 30 * bands, dtype=np.uint32).astype(np.uint8).reshape(20, 30, bands)
    (tmp_path / "c.png").write_bytes(png(pixels))
    stored = Terrain(shared_db).add(tmp_path / "c.png", "texture", SIZE)
    message = terrain_messages.image("c.png", Terrain(shared_db).read(stored))
    assert (message.encoding, message.step) == (encoding, 30 * bands)
    assert bytes(message.data) == pixels.tobytes()


def test_files_of_the_cpp_system_are_read(shared_db: store.Db) -> None:
    import gridfs

    grid = gridfs.GridFS(shared_db)
    grid.put(png(HEIGHTS), filename="a.png", time="2025-08-01T10:00:00", type="heightmap", id=4031, height=80,
             width=120, elevation=14, offset_x=0, offset_y=0, DataType="png")  # fmt: skip
    grid.put(b"other", filename="notes.txt")
    grid.put(b"v1", filename="b.pcd", metadata={"type": "static", "id": 3030, "time": "2025"})
    terrain = Terrain(shared_db)
    assert sorted((file.type, file.id, file.filename) for file in terrain.all()) == [
        ("heightmap", 4031, "a.png"), ("static", 3030, "b.pcd"),
    ]  # fmt: skip
    found = terrain.find("heightmap", "a.png")
    assert found is not None and (found.size("height"), found.time) == (80.0, "2025-08-01T10:00:00")


def test_only_the_newest_dynamic_clouds_stay(shared_db: store.Db) -> None:
    terrain = Terrain(shared_db)
    for number in range(NEWEST_KEPT + 3):
        terrain.put_dynamic("lidar", bytes([number]) * 300_000, {"cloud": {}})
    terrain.put_dynamic("other", b"x", {"cloud": {}})
    kept = terrain.all("dynamic", "lidar")
    assert [terrain.read(file)[0] for file in kept] == list(range(NEWEST_KEPT + 2, 2, -1))
    assert shared_db["fs.chunks"].count_documents({}) == 2 * NEWEST_KEPT + 1


def cloud(points: int = 10) -> Any:
    fields = [PointField(name=name, offset=4 * at, datatype=7, count=1) for at, name in enumerate("xyz")]
    message = PointCloud2(height=1, width=points, point_step=12, row_step=12 * points, fields=fields, is_dense=True)
    message.header.frame_id = "map"
    message.header.stamp.sec = 7
    message.data.frombytes(np.arange(3 * points, dtype=np.float32).tobytes())
    return message


def test_a_cloud_comes_back_as_it_was(shared_db: store.Db) -> None:
    sent = cloud()
    stored = Terrain(shared_db).put_dynamic("lidar", bytes(sent.data), terrain_messages.cloud_head(sent))
    found = Terrain(shared_db).find("dynamic")
    assert found is not None
    data = Terrain(shared_db).read(found)
    assert terrain_messages.cloud(stored.filename, found.more.get("cloud"), data) == sent
    assert "not one of ours" in refusal(lambda: terrain_messages.cloud("a.pcd", None, data))[1]


def test_clouds_that_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    short = cloud()
    short.data = short.data[:-1]
    assert "whose sizes say 120" in refusal(lambda: terrain_messages.cloud_head(short))[1]
    narrow = cloud()
    narrow.width = 11
    assert "whose sizes say" in refusal(lambda: terrain_messages.cloud_head(narrow))[1]
    monkeypatch.setattr(terrain_messages, "MAX_CLOUD", 100)
    assert "thin it out" in refusal(lambda: terrain_messages.cloud_head(cloud()))[1]


GREY = png(HEIGHTS)
FILES: dict[str, tuple[str, str, bytes, str]] = {
    "ending": ("a.tif", "heightmap", GREY, "ends with .png"),
    "no png": ("a.png", "heightmap", b"<svg/>" * 9, "is no PNG image"),
    "empty": ("a.png", "texture", b"", "is no PNG image"),
    "cut": ("a.png", "heightmap", GREY[:-30], "ends in the middle"),
    "no end": ("a.png", "heightmap", GREY[:-12], "ends in the middle"),
    "damaged": ("a.png", "heightmap", GREY[:60] + b"\x00\x01" + GREY[62:], "is damaged (checksum at byte"),
    "no header": ("a.png", "heightmap", terrain_files.PNG + GREY[-12:], "has no header"),
    "huge": ("a.png", "heightmap", header(4097, 10, 16, 0), "4097 x 10 pixels, at most 4096"),
    "no pixels": ("a.png", "heightmap", header(0, 10, 16, 0), "0 x 10 pixels"),
    "colour as heights": ("a.png", "heightmap", header(9, 9, 8, 2), "not 8-bit colour: convert it"),
    "palette": ("a.png", "texture", header(9, 9, 8, 3), "not 8-bit a palette: convert it"),
    "deep colour": ("a.png", "texture", header(9, 9, 16, 2), "not 16-bit colour"),
    "no mesh": ("a.ply", "mesh", b"solid cube", "does not begin as a .ply file does"),
    "no cloud": ("a.pcd", "static", b"\x00\x01", "does not begin as a .pcd file does"),
    "no array": ("a.npy", "dem", b"PK", "does not begin as a .npy file does"),
}


@pytest.mark.parametrize("name", FILES)
def test_a_wrong_file_is_refused(shared_db: store.Db, tmp_path: Path, name: str) -> None:
    file, type_, data, says = FILES[name]
    (tmp_path / file).write_bytes(data)
    code, text = refusal(lambda: Terrain(shared_db).add(tmp_path / file, type_, SIZE))
    assert (code, says in text) == ("BAD_TERRAIN", True), text
    assert Terrain(shared_db).all() == []


def test_sizes_and_names_that_are_refused(shared_db: store.Db, yard: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    terrain = Terrain(shared_db)
    assert "needs its width" in refusal(lambda: terrain.add(yard, "heightmap"))[1]
    assert "above 0 m" in refusal(lambda: terrain.add(yard, "heightmap", Size(0.0, 1.0, 1.0)))[1]
    assert "there is no such file" in refusal(lambda: terrain.add(yard.with_name("b.png"), "texture", SIZE))[1]
    assert "holds the control character U+000A" in refusal(lambda: terrain.put_dynamic("a\nb", b"", {}))[1]
    monkeypatch.setattr(terrain_files, "MAX_FILE", 100)
    assert "MB are allowed" in refusal(lambda: terrain.add(yard, "heightmap", SIZE))[1]
    assert "the image cannot be read" in refusal(lambda: terrain_messages.image("a", header(9, 9, 16, 0)))[1]


def test_a_file_that_lost_a_part_is_told(shared_db: store.Db, yard: Path) -> None:
    stored = Terrain(shared_db).add(yard, "heightmap", SIZE)
    shared_db["fs.chunks"].delete_many({})
    assert refusal(lambda: Terrain(shared_db).read(stored))[0] == "TERRAIN_MISSING"


def test_the_command_line(
    shared_db: store.Db, server: Any, yard: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    site = tmp_path / "site.yaml"
    site.write_text(f"{{name: t, domain: 43, store: {{database: {shared_db.name}}}, services: {{db: {{}}}}}}")
    monkeypatch.setenv("TMS_MONGODB_URI", server.uri)
    monkeypatch.setenv("TMS_SITE", str(site))

    def tms(*words: object) -> Result:
        return CliRunner().invoke(verb.command, [str(word) for word in words])

    sizes = ("--width", 120, "--height", 80, "--elevation", 14)
    assert json.loads(tms("add", yard, "--type", "heightmap", *sizes, "--json").stdout)["width"] == 120
    assert "needs its width" in str(tms("add", yard, "--type", "texture").exception)
    assert tms("add", yard, "--type", "dynamic").exit_code == 2
    assert [row["filename"] for row in json.loads(tms("list", "--json").stdout)] == ["yard.png"]
    assert "yard.png" in tms("list").stdout
    assert tms("get", "yard.png", tmp_path / "copy.png").exit_code == 0
    assert (tmp_path / "copy.png").read_bytes() == yard.read_bytes()
    assert "File exists" in str(tms("get", "yard.png", tmp_path / "copy.png").exception)
    assert "there is no terrain 'b'" in str(tms("get", "b", tmp_path / "b").exception)
    assert json.loads(tms("rm", "yard.png", "--json").stdout) == {"removed": 1}
