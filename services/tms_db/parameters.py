"""Parameter records in the database: one per (model_name, record_name), changed field by field."""

from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from pymongo.errors import DuplicateKeyError

from tms_config.clock import utc_now
from tms_db.arrays import Array
from tms_db.reasons import (
    DollarOrDot,
    FieldNoArray,
    MadeByOthers,
    NotChanged,
    OtherFields,
    OtherValue,
    RecordMissing,
    SetAndRemoved,
    StaticInUse,
)
from tms_db.records import (
    Document,
    Record,
    Value,
    bad,
    check_field,
    check_key,
    check_line,
    check_max_age,
    check_type,
    check_values,
    models_of,
    title,
)
from tms_db.store import Db, errors
from tms_reason.errors import DbError
from tms_reason.reason import Reason

ATTEMPTS = 20  # other processes may create and remove the record between our steps, but not for long


@dataclass(frozen=True)
class RecordEdit:
    """A change of one record. An empty `type` or `description` and a `max_age` of 0 keep the stored ones."""

    values: Mapping[str, Value]
    type: str = ""
    description: str = ""
    source: str = ""
    remove: Collection[str] = ()
    max_age: float = 0.0  # s; below 0 = no limit
    expected: Mapping[str, Value] = field(default_factory=dict)  # nothing is changed unless the record has these values

    @property
    def plain(self) -> bool:
        """Whether it only sets fields, whatever they hold now."""
        return not (self.type or self.description or self.remove or self.max_age or self.expected)

    def check(self, where: str) -> None:
        check_values(where, self.values)
        for name in self.remove:
            check_field(where, name)
            if name in self.values:
                raise bad(SetAndRemoved(where, name))
        check_values(where, self.expected)
        check_max_age(where, self.max_age, self.type)
        check_line(where, "description", self.description)
        check_line(where, "source", self.source)
        if self.type:
            check_type(where, self.type)

    def fields(self) -> Document:
        kept = {"type": self.type, "description": self.description, "max_age": max(0.0, self.max_age)}
        return {
            **self.values,
            **{key: value for key, value in kept.items() if value or (key == "max_age" and self.max_age)},
            "updated_at": utc_now(),
            "source": self.source,
        }


@dataclass(frozen=True)
class Loaded:
    """Names of the records that a load has made, changed or left."""

    created: list[str]
    changed: list[str]
    unchanged: list[str]


class Parameters:
    """The `parameter` collection."""

    def __init__(self, db: Db) -> None:
        self._records = db["parameter"]
        self._runs = db["run"]

    def get(self, model_name: str, record_name: str) -> Document:
        """The stored document.

        Raises:
            DbError: RECORD_MISSING.
        """
        with errors():
            document: Document | None = self._records.find_one(key_of(model_name, record_name))
        if document is None:
            raise _missing(model_name, record_name)
        return document

    def all(self, model_name: str = "") -> list[Document]:
        """Documents of one model, or all, by key."""
        wanted = {"model_name": model_name} if model_name else {}
        with errors():
            return list(self._records.find(wanted).sort([("model_name", 1), ("record_name", 1)]))

    def by_id(self, ids: list[Any]) -> list[Document]:
        """Documents by their `_id`; those that are gone are left out."""
        with errors():
            return list(self._records.find({"_id": {"$in": ids}}))

    def named(self, record_name: str) -> list[Document]:
        """Documents of this record name of all models, oldest first: the C++ system's reader asks by name only."""
        with errors():
            return list(self._records.find({"record_name": record_name}).sort("_id", 1))

    def set(self, model_name: str, record_name: str, change: RecordEdit, create: bool = False) -> bool:
        """Change the given fields in one atomic step, or make the record; returns whether it was made.

        Raises:
            DbError: BAD_RECORD, RECORD_MISSING, CONFLICT, or STATIC_RECORD while a run uses the record.
        """
        check_key(model_name, record_name)
        where = title(model_name, record_name)
        change.check(where)
        fields = change.fields()
        update: Document = {"$set": fields}
        if change.remove:
            update["$unset"] = dict.fromkeys(change.remove, "")
        for _ in range(ATTEMPTS):
            with errors():
                key = self._writable(model_name, record_name)
                if key is not None and self._records.update_one({**key, **change.expected}, update).matched_count:
                    return False
                if key is not None and change.expected and self._records.find_one(key) is not None:
                    raise self._conflict(key, where, change.expected)
                if not create or change.expected:
                    raise _missing(model_name, record_name)
                if self._insert(model_name, record_name, fields):
                    return True
        raise DbError(MadeByOthers(where), "BUSY")

    def change_array(self, key: tuple[str, str], name: str, change: Callable[[Array], Array], source: str) -> Array:
        """Change the array in one field in one atomic step; a missing field is an empty array. Returns the new one.

        Raises:
            DbError: BAD_RECORD, RECORD_MISSING, or STATIC_RECORD while a run uses the record.
        """
        check_key(*key)
        where = title(*key)
        for _ in range(ATTEMPTS):
            with errors():
                found = self._writable(*key)
                stored = None if found is None else (self._records.find_one(found) or {}).get(name)
                if found is None:
                    raise _missing(*key)
                if not isinstance(stored, list | None):
                    raise bad(FieldNoArray(f"{where}.{name}"))
                array = change(stored or [])
                edit = RecordEdit({name: array}, source=source)
                edit.check(where)
                if self._records.update_one({**found, name: stored}, {"$set": edit.fields()}).matched_count:
                    return array
        raise DbError(MadeByOthers(where), "BUSY")

    def holds(self, values: Mapping[str, Value]) -> bool:
        """Whether a record of any model has all these values.

        Raises:
            DbError: BAD_RECORD; a name that is an operator of the database.
        """
        for name in values:
            if not name or name.startswith("$"):
                raise bad(DollarOrDot("find_record", name[:40]))
        with errors():
            return self._records.find_one(dict(values), {"_id": 1}) is not None

    def remove(self, model_name: str, record_name: str) -> None:
        """Take a record away.

        Raises:
            DbError: RECORD_MISSING, or STATIC_RECORD while a run uses the record.
        """
        with errors():
            key = self._writable(model_name, record_name)
            if key is not None and self._records.delete_one(key).deleted_count:
                return
        raise _missing(model_name, record_name)

    def load(self, records: Iterable[Record], source: str) -> Loaded:
        """Make or change the records of a file; a record that has the same values already is not written.

        Fields that the file does not name stay: sensing may have added them.
        """
        done = Loaded([], [], [])
        for record in records:
            change = RecordEdit(record.values, record.type, record.description, source, max_age=record.max_age)
            if self._says(record):
                done.unchanged.append(record.name)
            elif self.set(record.model_name, record.record_name, change, create=True):
                done.created.append(record.name)
            else:
                done.changed.append(record.name)
        return done

    def _writable(self, model_name: str, record_name: str) -> Document | None:
        """The filter to write with, None if there is no such record.

        Two steps, since the embedded store scans the collection when a filter holds more than the key; a record
        that becomes static in between is changed once more.
        """
        key = key_of(model_name, record_name)
        stored = self._records.find_one(key, {"type": 1, "model_name": 1})
        if stored is None:
            return None
        self.refuse_in_use(model_name, record_name, stored)
        return key

    def refuse_in_use(self, model_name: str, record_name: str, stored: Document) -> None:
        """Refuse to change a static record while a run uses it.

        Raises:
            DbError: STATIC_RECORD.
        """
        if stored.get("type") == "static":
            names = [f"{model}/{name}" for model in models_of(stored) for name in (record_name, "*")]
            run = self._runs.find_one({"ended_at": None, "records": {"$in": names}}, {"run_id": 1})
            if run is not None:
                raise _static(title(model_name, record_name), run["run_id"])

    def _conflict(self, key: Document, where: str, expected: Mapping[str, Value]) -> DbError:
        stored = self._records.find_one(key) or {}
        other: list[Reason] = [
            OtherValue(name, repr(stored.get(name)), repr(want))
            for name, want in expected.items()
            if not same(stored.get(name), want)
        ]
        return DbError(NotChanged(where, tuple(other) or (OtherFields(),)))

    def _says(self, record: Record) -> bool:
        with errors():
            stored = self._records.find_one(key_of(record.model_name, record.record_name)) or {}
        wanted = {**record.values, "type": record.type}
        if record.description:
            wanted["description"] = record.description
        if record.max_age:
            wanted["max_age"] = record.max_age
        return all(same(stored.get(name), value) for name, value in wanted.items())

    def _insert(self, model_name: str, record_name: str, fields: Document) -> bool:
        head = {"model_name": model_name} if model_name else {}
        new = {**head, "type": "dynamic", "record_name": record_name, "description": "", **fields}
        try:
            self._records.insert_one(new)
        except DuplicateKeyError:  # another process has made it since our update: update that one
            return False
        return True


def key_of(model_name: str, record_name: str) -> Document:
    """The filter that finds a record."""
    # Shared records of the C++ system have no field model_name.
    return {"model_name": model_name if model_name else {"$in": [None, ""]}, "record_name": record_name}


def same(stored: Any, wanted: Any) -> bool:
    """Equal in value and type: 1, 1.0 and true are three different things to a reader."""
    if isinstance(wanted, list):
        return isinstance(stored, list) and len(stored) == len(wanted) and all(map(same, stored, wanted))
    return (
        bool(stored == wanted)
        and isinstance(stored, float) == isinstance(wanted, float)
        and (isinstance(stored, bool) == isinstance(wanted, bool))
    )


def _missing(model_name: str, record_name: str) -> DbError:
    return DbError(RecordMissing(title(model_name, record_name)))


def _static(where: str, run: str) -> DbError:
    return DbError(StaticInUse(where, run))
