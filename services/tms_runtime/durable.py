"""Files that are there after a power cut: what was written is on the disk, and so is the name it is found by."""

import os
from contextlib import suppress
from pathlib import Path


def sync_folder(folder: Path) -> None:
    """Put the names in a folder on the disk: those of files just made, renamed or removed."""
    file = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        os.fsync(file)
    finally:
        os.close(file)


def make_folder(folder: Path) -> None:
    """Make a folder and those above it, as far as they are missing."""
    if not folder.is_dir():
        make_folder(folder.parent)
        folder.mkdir(exist_ok=True)
        sync_folder(folder.parent)


def replace(path: Path, data: bytes) -> None:
    """Give a file new content; after a power cut it has the old one or the new one, and after the return the new one.

    Raises:
        OSError: the disk is full or fails.
    """
    make_folder(path.parent)
    part = path.with_name(path.name + ".part")  # files that differ in their suffix alone are written side by side
    file = os.open(part, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600)
    try:
        write_all(file, data)
        os.fsync(file)
    finally:
        os.close(file)
    part.replace(path)
    sync_folder(path.parent)


def write_all(file: int, data: bytes) -> None:
    """Write to the page cache; a disk that fills up meanwhile takes a part and then raises OSError."""
    view = memoryview(data)
    while view:
        view = view[os.write(file, view) :]


def set_aside(path: Path) -> Path:
    """Rename a file that cannot be read, for a person to look at; where even that fails, it stays where it is."""
    aside = path.with_name(path.name + ".unreadable")
    with suppress(OSError):
        path.replace(aside)
    return aside
