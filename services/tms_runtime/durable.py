"""Files that survive a power cut: their content is on the disk, and so is their name in the folder."""

import os
from contextlib import suppress
from pathlib import Path


def sync_folder(folder: Path) -> None:
    """Sync the names in a folder to the disk: those of files just made, renamed or removed."""
    file = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        os.fsync(file)
    finally:
        os.close(file)


def make_folder(folder: Path) -> None:
    """Make a folder and the folders above it, as far as they are missing."""
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
    part = path.with_name(path.name + ".part")  # files that differ only in their suffix are written at the same time
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
    """Rename a file that cannot be read, for a person to inspect; if that fails, it keeps its name."""
    aside = path.with_name(path.name + ".unreadable")
    with suppress(OSError):
        path.replace(aside)
    return aside
