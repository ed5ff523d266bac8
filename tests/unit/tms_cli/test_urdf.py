"""`tms urdf`: a machine of the site as a file."""

import json
import zipfile
from pathlib import Path

import pytest
from click.testing import CliRunner

from tms_cli.main import tms
from tms_reason.errors import TmsError


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("LC_ALL", "C.UTF-8")
    monkeypatch.delenv("TMS_SITE", raising=False)
    return tmp_path


def test_a_machine_is_written_once(here: Path) -> None:
    done = CliRunner().invoke(tms, ["urdf", "zx200"])
    assert (done.exit_code, done.stdout) == (0, "zx200_description.zip: zx200 as a ROS 2 package\n")
    with zipfile.ZipFile(here / "zx200_description.zip") as found:
        assert found.testzip() is None and "zx200_description/package.xml" in found.namelist()
    again = CliRunner().invoke(tms, ["urdf", "zx200"])
    assert "File exists" in str(again.exception or again.stderr)
    told = CliRunner().invoke(tms, ["urdf", "zx200", "--overwrite", "--json"])
    assert json.loads(told.stdout)["bytes"] == (here / "zx200_description.zip").stat().st_size


def test_a_machine_that_the_site_has_not(here: Path) -> None:
    done = CliRunner().invoke(tms, ["urdf", "zx999"])
    assert isinstance(done.exception, TmsError) and done.exception.code == "NO_MACHINE"
    assert list(here.iterdir()) == []
