"""Point clouds with anything wrong in them give a reason, or heights; no other error, and no end of the process."""

from pathlib import Path

import laspy
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import height_files as files
from height_files import EAST, LEVEL, NORTH
from tms_ground import reasons
from tms_ground.files.reading import Given, read
from tms_ground.frame import SiteFrame
from tms_ground.settings import Origin
from tms_reason.errors import TmsError

AREA = (0.0, 0.0, 20.0, 10.0)  # m
FRAME = SiteFrame(Origin(plane=9, north=NORTH, east=EAST, height=LEVEL))
NAMES = ("a.las", "a.laz")
FIRST = 30  # bytes of a point of format 6
WORDS = (0, 1, 2**31 - 1, 2**32 - 1, 2**63 - 1, 2**64 - 1)


@pytest.fixture(scope="module")
def clouds(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    folder = tmp_path_factory.mktemp("clouds")
    return {name: files.cloud(folder / name, step=1.0).read_bytes() for name in NAMES}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return Path(tmp_path_factory.mktemp("damaged"))


@st.composite
def damages(draw: st.DrawFn) -> list[tuple[float, bytes]]:
    """Places, as shares of the file or of its head, and what stands there instead."""
    place = st.floats(0, 1) | st.floats(0, 0.3)
    number = st.sampled_from(WORDS) | st.integers(0, 2**64 - 1)
    words = st.builds(lambda value, size: value.to_bytes(8, "little")[:size], number, st.sampled_from((1, 2, 4, 8)))
    return draw(st.lists(st.tuples(place, words), min_size=1, max_size=6))


@pytest.mark.parametrize("name", NAMES)
@given(damage=damages(), length=st.floats(0.5, 1) | st.just(1.0))
def test_anything_wrong_is_a_reason(
    folder: Path, clouds: dict[str, bytes], name: str, damage: list[tuple[float, bytes]], length: float
) -> None:
    data = bytearray(clouds[name])
    for place, words in damage:
        at = round(place * (len(data) - 8))
        data[at : at + len(words)] = words
    (folder / name).write_bytes(data[: round(length * len(data))])
    try:
        found = read(folder / name, AREA, 2.0, FRAME, Given(epsg=6677))
    except TmsError as error:
        assert isinstance(error.reason, reasons.GroundFile)
    else:
        assert found.z.shape == (5, 10)


def test_sizes_of_a_piece_that_do_not_fit(tmp_path: Path, clouds: dict[str, bytes]) -> None:
    """The library would make room for 4 GB, for each of the nine fields."""
    data = clouds["a.laz"]
    begin = int.from_bytes(data[96:100], "little") + 8  # behind the place of the table
    sizes = begin + FIRST + 4
    for field in range(9):
        path = tmp_path / "a.laz"
        at = sizes + 4 * field
        path.write_bytes(data[:at] + b"\xff" * 4 + data[at + 4 :])
        told = np.frombuffer(path.read_bytes()[sizes : sizes + 36], "<u4").sum(dtype=np.uint64)
        with pytest.raises(TmsError) as caught:
            read(path, AREA, 2.0, FRAME, Given(epsg=6677))
        assert isinstance(caught.value.reason, reasons.GroundFile)
        why = caught.value.reason.why
        assert isinstance(why, reasons.GroundFileDamaged) and why.problem.startswith(f"{told} B > ")


@pytest.mark.parametrize("kind", [0, 3, 6, 7, 8, 10])
def test_clouds_of_all_kinds_of_points_are_read(tmp_path: Path, kind: int) -> None:
    x, y = (one.ravel() for one in files.lattice(0.5))
    head = laspy.LasHeader(point_format=kind, version="1.4")
    head.offsets, head.scales = [EAST, NORTH, 0.0], [0.001, 0.001, 0.0001]
    head.add_extra_dims([laspy.ExtraBytesParams("extra", "uint16"), laspy.ExtraBytesParams("more", "float64")])
    las = laspy.LasData(head)
    las.x, las.y, las.z = x + EAST, y + NORTH, files.height(x, y) + LEVEL
    las["extra"], las["more"] = np.arange(x.size) % 60_000, x * y
    las.write(tmp_path / "a.laz")
    found = read(tmp_path / "a.laz", AREA, 1.0, FRAME, Given(epsg=6677))
    assert np.abs(found.z - files.height(*found.centres)).max() < 0.03
