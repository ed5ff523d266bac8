"""Files and their names are there after a power cut, and a failed write leaves the old content."""

import os
from pathlib import Path

import pytest

from power_cut import own_disk
from slow_disk import SMALL
from tms_runtime import durable


def test_new_content_and_new_folders_survive_a_power_cut(tmp_path: Path) -> None:
    with own_disk(tmp_path, SMALL) as disk:
        path = disk.folder / "a" / "b" / "file"
        durable.replace(path, b"old")
        durable.replace(path, b"new")
        disk.cut()
        assert path.read_bytes() == b"new"
        assert path.stat().st_mode & 0o777 == 0o600


def test_a_full_disk_leaves_the_old_content(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> int:
        raise OSError(28, "No space left on device")

    durable.replace(tmp_path / "file", b"old")
    monkeypatch.setattr(os, "write", full)
    with pytest.raises(OSError, match="No space"):
        durable.replace(tmp_path / "file", b"new")
    assert (tmp_path / "file").read_bytes() == b"old"


def test_what_is_set_aside_is_kept_and_a_name_that_is_gone_is_no_error(tmp_path: Path) -> None:
    (tmp_path / "file").write_bytes(b"?")
    assert durable.set_aside(tmp_path / "file").read_bytes() == b"?"
    assert not (tmp_path / "file").exists()
    durable.set_aside(tmp_path / "file")
