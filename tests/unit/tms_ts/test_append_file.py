"""A group of lines is in the file as a whole, or not at all and written again."""

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tms_runtime import durable
from tms_ts.append_file import AppendFile


def once(call: Callable[..., Any], does: Callable[..., Any]) -> Callable[..., Any]:
    """A call that does something else the first time, and then fails."""
    times: list[int] = []

    def wrapped(*words: Any) -> Any:
        times.append(1)
        if len(times) == 1:
            return does(*words)
        if len(times) == 2:
            raise OSError(28, "No space left on device")
        return call(*words)

    return wrapped


def test_what_a_full_disk_took_of_a_group_is_cut_off(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file, write = AppendFile(tmp_path / "new" / "file"), os.write
    file.write(b"first\n")
    file.sync()
    file.keep()
    monkeypatch.setattr(durable.os, "write", once(write, lambda fd, data: write(fd, data[:3])))
    with pytest.raises(OSError, match="No space"):
        file.write(b"second\n")
    assert (tmp_path / "new" / "file").read_bytes() == b"first\nsec"
    file.write(b"second\nthird\n")
    file.keep()
    assert (tmp_path / "new" / "file").read_bytes() == b"first\nsecond\nthird\n"
    assert file.size == 19
    file.close()


def test_a_group_whose_sync_failed_is_written_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The system marks pages that it could not write as clean: a second sync alone would say that all is well."""
    file = AppendFile(tmp_path / "file")
    file.write(b"first\n")
    with monkeypatch.context() as patch:
        patch.setattr(os, "fdatasync", once(os.fdatasync, lambda _: os.fdatasync(-1)))
        with pytest.raises(OSError):
            file.sync()
    written: list[bytes] = []
    monkeypatch.setattr(durable.os, "write", lambda fd, data: written.append(bytes(data)) or len(data))
    file.write(b"first\n")
    assert written == [b"first\n"]
    file.close()


def test_short_writes_are_no_loss(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file, write = AppendFile(tmp_path / "file"), os.write
    monkeypatch.setattr(durable.os, "write", lambda fd, data: write(fd, data[:2]))
    file.write(b"a line\n")
    assert (tmp_path / "file").read_bytes() == b"a line\n"
    file.close()
