"""The audit's file on this PC's disk (SQLite): notes that wait for the database, and the last place in the chain.

A note is on the disk before the thread that waits for it goes on. It is deleted in the same transaction that moves the
place after it: after a crash each note enters the chain once, with the number that it had.
"""

import json
import os
import sqlite3
import threading
from collections.abc import Sequence
from pathlib import Path

from tms_ur.audit_chain import ChainHead, Note

MAX_WAITING = 100_000  # notes; weeks of a database that is away
TABLES = """
create table if not exists waiting (id integer primary key autoincrement, note text not null);
create table if not exists place (one integer primary key check (one = 1), number integer not null, hash text not null);
"""


class LedgerFull(Exception):
    """The database was away for too long."""


class Ledger:
    """Every method may wait for the disk; when the disk fails, it raises sqlite3.Error or OSError."""

    def __init__(self, file: Path) -> None:
        """Open the file or make it."""
        file.parent.mkdir(parents=True, exist_ok=True)
        os.close(os.open(file, os.O_CREAT | os.O_RDWR, 0o600))
        self._lock = threading.Lock()
        self._db = sqlite3.connect(file, check_same_thread=False)
        try:
            self._db.execute("pragma synchronous = full")
            self._db.executescript(TABLES)
        except sqlite3.Error:
            self._db.close()
            raise

    def append(self, notes: Sequence[Note]) -> None:
        """Keep notes; they are on the disk when this returns.

        Raises:
            LedgerFull: too many notes wait.
        """
        with self._lock, self._db:
            (waiting,) = self._db.execute("select count(*) from waiting").fetchone()
            if waiting + len(notes) > MAX_WAITING:
                raise LedgerFull
            self._db.executemany("insert into waiting (note) values (?)", ((json.dumps(vars(one)),) for one in notes))

    def waiting(self, most: int) -> tuple[list[int], list[Note]]:
        """The oldest notes, and for each the number to give to `move` when it is stored."""
        with self._lock:
            rows = self._db.execute("select id, note from waiting order by id limit ?", (most,)).fetchall()
        return [row[0] for row in rows], [Note(**json.loads(row[1])) for row in rows]

    def place(self) -> ChainHead | None:
        """The last entry that is stored; None if this ledger has never been given one."""
        with self._lock:
            row = self._db.execute("select number, hash from place").fetchone()
        return None if row is None else ChainHead(*row)

    def move(self, place: ChainHead, done: int = 0) -> None:
        """Note that the chain goes on after `place`, and delete the notes up to `done`, which are stored."""
        with self._lock, self._db:
            self._db.execute("insert or replace into place values (1, ?, ?)", (place.number, place.hash))
            self._db.execute("delete from waiting where id <= ?", (done,))

    def close(self) -> None:
        with self._lock:
            self._db.close()


def opened(file: Path) -> tuple[Ledger, bool]:
    """Open the ledger; True if it is new because the old one is unreadable and was renamed."""
    try:
        return Ledger(file), False
    except sqlite3.OperationalError:  # no room, no permission: it may be readable later
        raise
    except sqlite3.DatabaseError:
        file.replace(file.with_suffix(".unreadable"))
        file.with_name(file.name + "-journal").unlink(missing_ok=True)
        return Ledger(file), True


def reported(file: Path) -> ChainHead | None:
    """The last stored entry by the ledger of this PC; None if the console has run on another PC."""
    if not file.exists():
        return None
    ledger = sqlite3.connect(f"file:{file}?mode=ro", uri=True)
    try:
        row = ledger.execute("select number, hash from place").fetchone()
    finally:
        ledger.close()
    return None if row is None else ChainHead(*row)
