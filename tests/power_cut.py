"""A disk of its own for a test, which can stall and lose its power: an ext4 image on a loop device. Needs root."""

import fcntl
import os
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

import psutil
import pytest

EXT4_IOC_SHUTDOWN = 0x8004587D
NO_LOG_FLUSH = (2).to_bytes(4, "little")  # EXT4_GOING_FLAGS_NOLOGFLUSH: what was not synced is gone
FIFREEZE, FITHAW = 0xC0045877, 0xC0045878
GONE = 10.0  # s for killed processes to be gone


class Disk:
    """Mounted at `folder` from its making to its end, but for a moment during a power cut."""

    def __init__(self, image: Path, folder: Path) -> None:
        self._image, self.folder = image, folder
        folder.mkdir()
        _do("mkfs.ext4", "-q", str(image))
        self._mount()

    def cut(self, pids: Sequence[int] = ()) -> None:
        """Kill these processes, the first one first, and lose the power; afterwards the disk is there again.

        They are all frozen before: none gets to know that another one is gone.
        """
        victims = _processes(pids)
        for step in (psutil.Process.suspend, psutil.Process.kill):
            for victim in victims:
                with suppress(psutil.NoSuchProcess):
                    step(victim)
        _, alive = psutil.wait_procs(victims, GONE)
        assert not alive, f"killed, but not gone: {alive}"
        self._control(EXT4_IOC_SHUTDOWN, NO_LOG_FLUSH)
        _do("umount", str(self.folder))
        self._mount()

    @contextmanager
    def stalled(self) -> Iterator[None]:
        """Inside, every write and sync waits."""
        self._control(FIFREEZE)
        try:
            yield
        finally:
            self._control(FITHAW)

    def _mount(self) -> None:
        # A busy PC takes longer than the 5 s after which a file system writes names and sizes by itself.
        _do("mount", "-o", "loop,commit=600", str(self._image), str(self.folder))

    def _control(self, request: int, argument: bytes = bytes(4)) -> None:
        file = os.open(self.folder, os.O_RDONLY)
        try:
            fcntl.ioctl(file, request, argument)
        finally:
            os.close(file)


@contextmanager
def own_disk(folder: Path, size: int = 2**30) -> Iterator[Disk]:
    """A disk of `size` bytes, mounted below `folder`."""
    if os.geteuid() != 0:
        pytest.skip("only root can mount a disk that loses its power: `sudo make test`")
    image = folder / "disk.img"
    with image.open("wb") as file:
        file.truncate(size)
    disk = Disk(image, folder / "disk")
    try:
        yield disk
    finally:
        _do("umount", "--lazy", str(disk.folder))  # also when a failed test has left files open there
        image.unlink()


def family(pid: int) -> list[int]:
    """A process and all that it has started, itself first."""
    parent = psutil.Process(pid)
    return [pid, *(child.pid for child in parent.children(recursive=True))]


def _processes(pids: Sequence[int]) -> list[psutil.Process]:
    found = []
    for pid in pids:
        with suppress(psutil.NoSuchProcess):
            found.append(psutil.Process(pid))
    return found


def _do(*words: str) -> None:
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"{' '.join(words)}: {done.stderr}"
