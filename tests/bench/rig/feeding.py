"""A made-up site whose console is fed while it is measured."""

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from browser.yard import Yard, serving


@contextmanager
def fed(yard: Yard, folder: Path, feed: Callable[[threading.Event], None]) -> Iterator[str]:
    """Its console; gives the address. `feed` runs in a thread, until its event is set at the latest."""
    leave = threading.Event()
    feeder = threading.Thread(target=feed, args=(leave,), daemon=True)
    with serving(yard, folder) as address:
        feeder.start()
        yield address
        leave.set()
        feeder.join(10)
