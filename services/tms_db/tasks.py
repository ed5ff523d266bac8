"""Tasks in the database: behaviour trees under the lowest free number, each text once."""

import hashlib
import threading
from collections.abc import Collection
from dataclasses import dataclass
from datetime import datetime, timezone
from typing import Any

from pymongo.errors import BulkWriteError

from tms_config.clock import utc_now
from tms_db import task_text
from tms_db.reasons import NoTaskNumber, TaskMissing
from tms_db.store import Db, errors
from tms_db.task_numbers import TaskNumbers
from tms_reason.errors import DbError
from tms_reason.names import check_text

ATTEMPTS = 1000  # each lost race means that another process has stored a task
DUPLICATE = 11000  # MongoDB's code for a key that is there already
EPOCH = datetime.fromtimestamp(0, timezone.utc)
MAX_TASK_ID = 2**31 - 1  # task_id is int32
LISTED = {"_id": 0, "task_sequence": 0}


@dataclass(frozen=True)
class Task:
    """A stored task (Table 1 of the paper); `task_sequence` is empty in lists."""

    task_id: int
    model_name: str
    description: str
    task_sequence: str
    added_at: datetime


@dataclass(frozen=True)
class Added:
    """What came of storing a task."""

    task_id: int
    model_name: str
    already_stored: bool


@dataclass
class _Wish:
    """A text that a caller wants to store."""

    essence: str
    document: dict[str, Any]
    added: Added | None = None
    failure: DbError | None = None

    @property
    def digest(self) -> str:
        return str(self.document["text_sha256"])

    @property
    def open(self) -> bool:
        return self.added is None and self.failure is None


class Tasks:
    """The `task` collection."""

    def __init__(self, db: Db) -> None:
        self._tasks = db["task"]
        self._numbers = TaskNumbers(self._tasks)
        self._wishes: list[_Wish] = []
        self._wishing, self._storing = threading.Lock(), threading.Lock()

    def add(self, text: str, description: str = "", models: Collection[str] = task_text.MODELS) -> Added:
        """Store a task's XML text, or find the number under which it is stored.

        The texts of threads that call at the same time are stored together; each thread waits for that.

        Raises:
            TaskError: the text is no task.
            TmsError: the description holds a control character.
            DbError: the store is away.
        """
        wish = _wish(text, description, models)
        with self._wishing:
            self._wishes.append(wish)
        with self._storing:
            if wish.open:
                with self._wishing:
                    wishes, self._wishes = self._wishes, []
                self._store(wishes)
        if wish.added is None:
            raise wish.failure or DbError(NoTaskNumber(ATTEMPTS), "BUSY")
        return wish.added

    def _store(self, wishes: list[_Wish]) -> None:
        """Store the wishes. Unique indexes decide races between processes; who loses one searches again."""
        try:
            with errors():
                for _ in range(ATTEMPTS):
                    self._find(wishes)
                    missing = list({wish.digest: wish for wish in reversed(wishes) if wish.open}.values())
                    if not missing:
                        return
                    self._insert(missing[::-1])
        except DbError as error:
            for wish in wishes:
                wish.failure = error if wish.open else None

    def _find(self, wishes: list[_Wish]) -> None:
        """Find the wishes that are stored already."""
        what = {"task_id": 1, "model_name": 1, "text_sha256": 1}
        digests = list({wish.digest for wish in wishes if wish.open})
        stored = {same["text_sha256"]: same for same in self._tasks.find({"text_sha256": {"$in": digests}}, what)}
        foreign = self._numbers.foreign()
        for wish in [wish for wish in wishes if wish.open]:
            same = stored.get(wish.digest)
            if same is None and foreign:
                same = self._tasks.find_one({"text_sha256": {"$exists": False}, "task_sequence": wish.essence}, what)
            if same is not None:
                wish.added = Added(int(same["task_id"]), str(same.get("model_name") or ""), True)

    def _insert(self, wishes: list[_Wish]) -> None:
        """Store the wishes under the lowest free numbers, except where another process was faster."""
        now = utc_now()
        numbers = self._numbers.lowest_free(len(wishes))
        documents = [{"task_id": n, **w.document, "added_at": now} for n, w in zip(numbers, wishes, strict=True)]
        lost: set[int] = set()
        try:
            self._tasks.insert_many(documents, ordered=False)
        except BulkWriteError as error:
            lost = {row["index"] for row in error.details["writeErrors"] if row["code"] == DUPLICATE}
            if len(lost) < len(error.details["writeErrors"]):
                raise
            self._numbers.forget()
        for index, (number, wish) in enumerate(zip(numbers, wishes, strict=True)):
            if index not in lost:
                self._numbers.took(number)
                wish.added = Added(number, str(wish.document["model_name"]), False)

    def get(self, task_id: int) -> Task:
        """The task with this number.

        Raises:
            DbError: TASK_MISSING.
        """
        with errors():
            document = self._tasks.find_one({"task_id": task_id})
        if document is None:
            raise _missing(task_id)
        return _task(document)

    def all(self) -> list[Task]:
        """All tasks by number, without their texts."""
        with errors():
            found = self._tasks.find({"task_id": {"$gte": 1, "$lte": MAX_TASK_ID}}, LISTED).sort("task_id", 1)
            return [_task(document) for document in found]

    def remove(self, task_id: int) -> None:
        """Take a task away; its number becomes free.

        Raises:
            DbError: TASK_MISSING.
        """
        with errors():
            gone = self._tasks.delete_one({"task_id": task_id}).deleted_count
        self._numbers.forget()
        if not gone:
            raise _missing(task_id)


def document(text: str, description: str, models: Collection[str]) -> dict[str, Any]:
    """The document of a task without its number, with its fields checked.

    Raises:
        TaskError, TmsError: as `Tasks.add`.
    """
    return _wish(text, description, models).document


def _wish(text: str, description: str, models: Collection[str]) -> _Wish:
    check_text("description", description)
    essence = task_text.essence(text)
    document = {
        "type": "task",
        "model_name": task_text.main_model(essence, models),
        "description": description.strip() or task_text.NO_DESCRIPTION,
        "task_sequence": text.removeprefix("\ufeff"),  # unchanged, so that line numbers are those of the file
        "text_sha256": hashlib.sha256(essence.encode()).hexdigest(),
    }
    return _Wish(essence, document)


def _missing(task_id: int) -> DbError:
    return DbError(TaskMissing(task_id))


def _task(document: dict[str, Any]) -> Task:
    return Task(
        task_id=int(document["task_id"]),
        model_name=str(document.get("model_name") or ""),
        description=str(document.get("description") or ""),
        task_sequence=str(document.get("task_sequence") or ""),
        added_at=document.get("added_at", EPOCH),
    )
