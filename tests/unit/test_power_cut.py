"""The rig itself: what was synced is there after the power cut, what was only written is not; a stalled disk waits."""

import os
import subprocess
import sys
import threading
from pathlib import Path

import psutil

from power_cut import family, own_disk

SMALL = 64 * 2**20  # bytes


def test_only_what_was_synced_survives(tmp_path: Path) -> None:
    with own_disk(tmp_path, SMALL) as disk:
        with (disk.folder / "file").open("wb") as file:
            file.write(b"synced")
            file.flush()
            os.fsync(file.fileno())
            file.write(b", written")
        (disk.folder / "other").write_bytes(b"x")
        assert (disk.folder / "file").read_bytes() == b"synced, written"
        disk.cut()
        assert (disk.folder / "file").read_bytes() == b"synced"
        assert not (disk.folder / "other").exists()
        (disk.folder / "other").write_bytes(b"it works again")


def test_the_processes_are_gone_and_do_nothing_more(tmp_path: Path) -> None:
    ticks = "import time\nfor i in range(9999): open('ticks', 'a').write('x'); time.sleep(0.001)"
    with own_disk(tmp_path, SMALL) as disk:
        words = ["sh", "-c", f'"{sys.executable}" -c "{ticks}" & wait']
        with subprocess.Popen(words, cwd=disk.folder) as shell:
            while not (disk.folder / "ticks").exists():
                assert shell.poll() is None
            pids = family(shell.pid)
            disk.cut(pids)
        assert len(pids) == 2 and not any(map(psutil.pid_exists, pids))


def test_a_stalled_disk_makes_writers_wait(tmp_path: Path) -> None:
    with own_disk(tmp_path, SMALL) as disk:
        path, written = disk.folder / "file", threading.Event()
        writer = threading.Thread(target=lambda: (path.write_bytes(b"late"), written.set()))
        with disk.stalled():
            writer.start()
            assert not written.wait(0.3)
        assert written.wait(10)
        writer.join()
