"""A folder whose disk can stall: a real one where we are root, otherwise the calls that wait for a disk wait."""

import os
import threading
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from power_cut import own_disk

SMALL = 64 * 2**20  # bytes


@dataclass
class SlowDisk:
    """`with stalled():` nothing gets onto the disk below `folder`."""

    folder: Path
    stalled: Callable[[], AbstractContextManager[None]]


@contextmanager
def slow_disk(folder: Path) -> Iterator[SlowDisk]:
    """A disk for one test."""
    if os.geteuid() == 0:
        with own_disk(folder, SMALL) as disk:
            yield SlowDisk(disk.folder, disk.stalled)
    else:
        yield SlowDisk(folder, _stalled_calls)


@contextmanager
def _stalled_calls() -> Iterator[None]:
    works = threading.Event()

    def waiting(call: Callable[..., Any]) -> Callable[..., Any]:
        def wait_and_call(*words: Any) -> Any:
            assert works.wait(60)
            return call(*words)

        return wait_and_call

    with pytest.MonkeyPatch.context() as patch:
        for name in ("fsync", "fdatasync"):
            patch.setattr(os, name, waiting(getattr(os, name)))
        try:
            yield
        finally:
            works.set()
