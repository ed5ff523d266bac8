"""What a gateway keeps of areas: whole, checked against its id, and never less than it knew."""

import json
from pathlib import Path

import pytest

from tms_areas.areas import Area, AreaSet
from tms_areas.braking import MOST
from tms_rc.area_file import AreaFile, Enabled
from tms_rc.area_path import area_path
from tms_rc.braking_file import BrakingFile
from tms_rc.reasons import AreasNotEnabled, AreasUnreadable
from tms_reason.errors import TmsError
from tms_reason.reason import Reason

SET = AreaSet((Area("yard", "unmanned", ((0, 0), (9, 0), (9, 9)), "置場"),))


def reason(file: AreaFile) -> Reason:
    with pytest.raises(TmsError) as caught:
        file.read()
    return caught.value.reason


def test_what_was_enabled_is_read_again(tmp_path: Path) -> None:
    file = AreaFile(tmp_path, "zx200")
    assert reason(file) == AreasNotEnabled() and not area_path(tmp_path, "zx200").exists()
    file.keep(Enabled(SET, "a person", 7.0))
    assert file.read() == Enabled(SET, "a person", 7.0) and area_path(tmp_path, "zx200").exists()


@pytest.mark.parametrize("spoil", [lambda text: text[:-9], lambda _: "[]", lambda _: "", lambda t: t.replace("9", "8")])
def test_a_file_that_was_changed_is_none(tmp_path: Path, spoil: object) -> None:
    file = AreaFile(tmp_path, "zx200")
    file.keep(Enabled(SET, "a person", 7.0))
    path = tmp_path / "rc" / "zx200.areas"
    assert callable(spoil)
    path.write_text(spoil(path.read_text()))
    assert reason(file) == AreasUnreadable()


def test_how_it_brakes_is_known_after_a_restart_and_unknown_is_the_worst(tmp_path: Path) -> None:
    file = BrakingFile(tmp_path, "zx200")
    assert file.read() == 1.0
    file.keep(1.4)
    assert file.read() == pytest.approx(1.4)
    path = tmp_path / "rc" / "zx200.braking"
    path.write_text(json.dumps({"factor": 0.2}))
    assert file.read() == 1.0
    path.write_text("{")
    assert file.read() == MOST
