"""Store servers for the tests: a process of our own, or a MongoDB that somebody runs."""

import os
import socket
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from tms_config.config import PROJECT
from tms_db import store
from tms_reason.reason import Reason

PROGRAM = PROJECT / ".venv-store" / "bin" / "secantusd-py"
PREFIX = "tms_test_"  # of the databases that tests make in a MongoDB, and drop


class Server:
    """A store server of our own, on a free port, that can die and come back."""

    def __init__(self, folder: Path) -> None:
        self.more: list[str] = []  # words on its command line
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        self.folder = folder
        self.uri = f"mongodb://127.0.0.1:{self.port}/?directConnection=true"
        self.start()

    def start(self) -> None:
        hidden = ("LD_LIBRARY_PATH", "_ROS_WHEELS_BOOTSTRAP_COMPLETE", "PYTHONPATH")
        clean = {key: value for key, value in os.environ.items() if key not in hidden}
        words = [str(PROGRAM), "--host", "127.0.0.1", "--port", str(self.port), "--storage-path", str(self.folder)]
        self.process = subprocess.Popen(
            [*words, "--cache-size", "64M", *self.more], env=clean, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        deadline = time.monotonic() + 20
        while time.monotonic() < deadline and self.process.poll() is None:
            with socket.socket() as probe:
                if probe.connect_ex(("127.0.0.1", self.port)) == 0:
                    return
            time.sleep(0.02)
        self.end(kill=True)
        pytest.fail(f"{PROGRAM} did not open port {self.port}")

    def end(self, kill: bool = False) -> None:
        if kill:
            self.process.kill()
        else:
            self.process.terminate()
        self.process.wait(10)

    def open(self, database: str = "rostmsdb", answer_ms: int = store.ANSWER_MS) -> store.Db:
        db = store.connect(self.uri, database, answer_ms)
        store.prepare(db)
        return db

    def forget(self, db: store.Db) -> None:
        """The whole server goes away with the tests."""
        db.client.close()


class MongoDb:
    """A MongoDB that somebody runs for the tests; they use databases of their own and drop them."""

    def __init__(self, uri: str) -> None:
        self.uri = uri

    def open(self, database: str, answer_ms: int = store.ANSWER_MS) -> store.Db:
        db = store.connect(self.uri, PREFIX + database, answer_ms)
        db.client.drop_database(db)
        store.prepare(db)
        return db

    def forget(self, db: store.Db) -> None:
        db.client.close()  # which the test may have done itself
        again = store.connect(self.uri, db.name)
        again.client.drop_database(db.name)
        again.client.close()


class Connection:
    """A connection as a keeper sees it, to a store that may be away."""

    away = False

    def unready(self) -> Reason | None:
        return store.down().reason if self.away else None

    @contextmanager
    def use(self) -> Iterator[None]:
        if self.away:
            raise store.down()
        yield
