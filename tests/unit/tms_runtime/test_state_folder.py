"""The state folder is for its user alone."""

import os
from pathlib import Path

import pytest

from tms_config.reasons import BadFile
from tms_reason.errors import ConfigError
from tms_runtime import state_folder
from tms_runtime.reasons import OthersFile


def mode(path: Path) -> int:
    return path.stat().st_mode & 0o777


def test_what_is_written_is_private(tmp_path: Path) -> None:
    folder = tmp_path / "above" / "state"
    state_folder.make(folder)
    state_folder.make(folder)
    assert mode(folder) == 0o700
    before = os.umask(0o022)
    os.umask(before)
    with state_folder.private():
        (folder / "log").mkdir()
        (folder / "log" / "a.log").touch()
    assert (mode(folder / "log"), mode(folder / "log" / "a.log")) == (0o700, 0o600)
    assert os.umask(before) == before


def test_what_an_older_release_left_is_closed(tmp_path: Path) -> None:
    folder, elsewhere = tmp_path / "state", tmp_path / "elsewhere"
    (folder / "store" / "data").mkdir(parents=True)
    files = [folder / "supervisord.conf", folder / "store" / "data" / "one", elsewhere]
    for file in files:
        file.touch()
        file.chmod(0o664)
    for place in (folder, folder / "store", folder / "store" / "data"):
        place.chmod(0o755)
    (folder / "program").touch(0o700)
    (folder / "link").symlink_to(elsewhere)
    (folder / "broken").symlink_to(tmp_path / "nothing")

    assert state_folder.tighten(folder) == 5
    assert [mode(file) for file in files] == [0o600, 0o600, 0o664]  # nothing behind a link is touched
    assert {mode(place) for place in (folder, folder / "store", folder / "store" / "data")} == {0o700}
    assert mode(folder / "program") == 0o700
    assert state_folder.tighten(folder) == 0


def test_a_file_of_another_user_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "a").touch()
    (tmp_path / "a").chmod(0o644)
    tmp_path.chmod(0o700)

    def refuse(*_: object, **__: object) -> None:
        raise PermissionError

    monkeypatch.setattr(Path, "chmod", refuse)
    with pytest.raises(ConfigError) as caught:
        state_folder.tighten(tmp_path)
    assert caught.value.reason == BadFile(str(tmp_path / "a"), OthersFile(os.getuid()))
