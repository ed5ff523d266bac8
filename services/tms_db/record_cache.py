"""The records that tms:db keeps in memory, so that it can check and read them without a call of the store.

The store does one thing at a time, so a read after a write of fifty records would wait for all of them. Records that
are written here are kept for a moment; records that are only read are kept until the store reports a change.
"""

import threading
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from tms_config.clock import monotonic
from tms_db.parameters import Parameters
from tms_db.reasons import NoneOfFields, OtherKind, StaticFromSensing
from tms_db.records import RESERVED, Document, Value, bad, title
from tms_reason.errors import DbError
from tms_ros.node import Ros

KEPT = 2.0  # s: other programs may write to the same database
FOR_EVER = float("inf")
Key = tuple[str, str]


@dataclass
class Head:
    """A record with its updates that are not stored yet."""

    document: Document
    until: float  # s, monotonic; after that it is read again, and this one is used meanwhile
    since: Document | None = None  # fields that have changed since that reading began
    written: float = float("-inf")  # s, monotonic; last write by this process

    @property
    def quiet(self) -> bool:
        """Whether it was only read, and the store reports changes."""
        return self.until == FOR_EVER

    def change(self, fields: Document) -> None:
        """Take new values that are not stored yet."""
        self.written = monotonic()
        self.until = min(self.until, self.written + KEPT)
        self.document.update(fields)
        if self.since is not None:
            self.since.update(fields)

    @property
    def id(self) -> Any:
        return self.document["_id"]

    @property
    def type(self) -> str:
        return str(self.document.get("type") or "")

    def fit(self, where: str, values: Mapping[str, Value], loose: bool) -> dict[str, Value]:
        """The values in the types of the record's fields.

        A loose update names fields in whatever case and drops what the record does not have.

        Raises:
            DbError: BAD_RECORD for another kind of value than the stored one, or none that fits.
        """
        if loose:
            by_name = {name.lower(): value for name, value in values.items()}
            fields = [name for name in self.document if name not in RESERVED and name.lower() in by_name]
            values = {name: by_name[name.lower()] for name in fields}
            if not values:
                raise bad(NoneOfFields(where, tuple(by_name)))
        return {name: _fitting(f"{where}.{name}", self.document.get(name), value) for name, value in values.items()}


class RecordCache:
    """Heads by key; used on the executor thread, except for reading again in the background."""

    def __init__(
        self, parameters: Parameters, newest: Callable[[Key], Document], ros: Ros, watched: Callable[[], bool]
    ) -> None:
        """`newest`: fields of a record that are not stored yet; `watched`: whether the store reports changes."""
        self._parameters, self._newest, self._ros, self._watched = parameters, newest, ros, watched
        self._heads: dict[Key, Head] = {}
        self._keys: dict[Any, Key] = {}  # by _id, of present and former heads
        self._reading = False

    def known(self, key: Key) -> Head | None:
        """The head of a record that is in memory; None if there is none that may be used."""
        head = self._heads.get(key)
        if head is None or (head.quiet and not self._watched()) or monotonic() > head.until + KEPT:
            return None
        return head

    def document(self, key: Key) -> Document:
        """The record, to be read only.

        Raises:
            DbError: as `get`.
        """
        head = self.known(key)
        if head is None:
            self._heads.pop(key, None)
            watched = self._watched()  # before it is read: a change after that is reported
            head = Head(self.read(key), FOR_EVER)
            if watched:
                self._keep(key, head)
        return head.document

    def changed(self, identity: Any) -> None:
        """Take the store's report that the record with this _id has changed, with None any record; from any thread."""
        key = self._keys.get(identity)
        head = self._heads.get(key) if key is not None else None
        if head is not None and monotonic() - head.written < KEPT:  # most likely our own; it is read again soon
            return
        # On the executor thread, so after a reading that runs there.
        self._ros.on_executor(lambda: self.forget() if identity is None else self._drop(identity))

    def _keep(self, key: Key, head: Head) -> None:
        if isinstance(head.document.get("model_name"), list):  # a change under another model's name would be missed
            return
        self._heads[key] = head
        self._keys[head.id] = key

    def _drop(self, identity: Any) -> None:
        key = self._keys.pop(identity, None)
        if key is not None:
            self._heads.pop(key, None)

    def get(self, key: Key) -> Head:
        """The head of a stored record, to change it.

        Raises:
            DbError: RECORD_MISSING, or the store is away.
        """
        head = self.known(key)
        if head is None:
            self._heads.pop(key, None)
            head = Head(self.read(key), monotonic() + KEPT)
            self._keep(key, head)
        elif monotonic() > head.until and not self._reading:
            self._read_again()
        return head

    def _read_again(self) -> None:
        """Read all heads that are due, in the background: other programs may have changed these records."""
        now = monotonic()
        self._heads = {key: head for key, head in self._heads.items() if now < head.until + KEPT}
        due = {key: head for key, head in self._heads.items() if now > head.until - KEPT / 2}
        for key, head in due.items():
            head.since = self._newest(key)
        self._reading = True
        threading.Thread(target=self._read_due, args=(due,), name="records", daemon=True).start()

    def _read_due(self, due: dict[Key, Head]) -> None:
        found = None
        try:
            found = {document["_id"]: document for document in self._parameters.by_id([h.id for h in due.values()])}
        except DbError:  # the next writer gets the error
            pass
        finally:
            self._ros.on_executor(lambda: self._read(due, found))

    def _read(self, due: dict[Key, Head], found: dict[Any, Document] | None) -> None:
        self._reading = False
        for key, head in due.items():
            since, head.since = head.since or {}, None
            if found is None or self._heads.get(key) is not head:
                continue
            if head.id in found:
                head.document, head.until = {**found[head.id], **since}, monotonic() + KEPT
            else:
                del self._heads[key]

    def read(self, key: Key) -> Document:
        """The record with its updates that are not stored yet; these are read first, so that none is missed.

        Raises:
            DbError: RECORD_MISSING, or the store is away.
        """
        newer = self._newest(key)
        return {**self._parameters.get(*key), **newer}

    def dynamic(self, key: Key) -> Head:
        """The head of a record that may change while runs use it.

        Raises:
            DbError: STATIC_RECORD, or as `get`.
        """
        head = self.get(key)
        if head.type == "static":
            raise DbError(StaticFromSensing(title(*key)), "STATIC_RECORD")
        return head

    def forget(self) -> None:
        """Drop all heads: records were made, changed by hand or removed, or updates could not be stored."""
        self._heads.clear()
        self._keys.clear()


def _fitting(where: str, stored: Any, value: Value) -> Value:
    if stored is None or stored == []:
        return value
    kinds = _kind(stored), _kind(value)
    if kinds[0] != kinds[1]:
        raise bad(OtherKind(where, *kinds))
    if isinstance(stored, float) and isinstance(value, int):
        return float(value)
    return value


def _kind(value: Any) -> str:
    if isinstance(value, (list, tuple)):
        return "an array"
    if isinstance(value, bool):
        return "true/false"
    return "a number" if isinstance(value, (int, float)) else "a text"
