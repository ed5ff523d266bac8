"""Tasks in the database: behaviour trees under the lowest free number, each text once."""

import hashlib
from collections.abc import Collection
from dataclasses import dataclass
from datetime import datetime, timezone
from typing import Any

from pymongo.errors import DuplicateKeyError

from tms_core.errors import DbError
from tms_db import task_text
from tms_db.store import Db, errors

ATTEMPTS = 1000  # each lost race means that somebody else has registered a task
EPOCH = datetime.fromtimestamp(0, timezone.utc)
MOST = 2**31 - 1  # task_id is int32
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
    task_id: int
    model_name: str
    already_stored: bool


class Tasks:
    """The `task` collection."""

    def __init__(self, db: Db) -> None:
        self._tasks = db["task"]

    def add(self, text: str, description: str = "", models: Collection[str] = task_text.MODELS) -> Added:
        """Store a task's XML text, or find the number under which it is stored.

        The unique indexes decide races between processes: who loses one looks again.

        Raises:
            TaskError: the text is no task.
            DbError: the store is away.
        """
        essence = task_text.essence(text)
        digest = hashlib.sha256(essence.encode()).hexdigest()
        document = {
            "type": "task",
            "model_name": task_text.main_model(essence, models),
            "description": description.strip() or task_text.NO_DESCRIPTION,
            "task_sequence": text.removeprefix("\ufeff"),  # as it was drawn: line numbers stay those of the file
            "text_sha256": digest,
        }
        for _ in range(ATTEMPTS):
            with errors():
                same = self._stored(digest, essence)
                if same is not None:
                    return Added(int(same["task_id"]), str(same.get("model_name") or ""), True)
                number = self._lowest_free()
                try:
                    added_at = datetime.now(timezone.utc)
                    self._tasks.insert_one({"task_id": number, **document, "added_at": added_at})
                except DuplicateKeyError:
                    continue
                return Added(number, str(document["model_name"]), False)
        raise DbError(f"no free task number after {ATTEMPTS} attempts: try again", "BUSY")

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
            found = self._tasks.find({"task_id": {"$gte": 1, "$lte": MOST}}, LISTED).sort("task_id", 1)
            return [_task(document) for document in found]

    def remove(self, task_id: int) -> None:
        """Take a task away; its number becomes free.

        Raises:
            DbError: TASK_MISSING.
        """
        with errors():
            gone = self._tasks.delete_one({"task_id": task_id}).deleted_count
        if not gone:
            raise _missing(task_id)

    def _stored(self, digest: str, essence: str) -> dict[str, Any] | None:
        what = {"task_id": 1, "model_name": 1}
        # The second look finds a task that the C++ system stored, without a hash.
        return self._tasks.find_one({"text_sha256": digest}, what) or self._tasks.find_one(
            {"text_sha256": {"$exists": False}, "task_sequence": essence}, what
        )

    def _lowest_free(self) -> int:
        taken = {document.get("task_id") for document in self._tasks.find({}, {"_id": 0, "task_id": 1})}
        return next(number for number in range(1, len(taken) + 2) if number not in taken)


def _missing(task_id: int) -> DbError:
    return DbError(f"there is no task {task_id}: `tms task list` shows what is stored", "TASK_MISSING")


def _task(document: dict[str, Any]) -> Task:
    return Task(
        task_id=int(document["task_id"]),
        model_name=str(document.get("model_name") or ""),
        description=str(document.get("description") or ""),
        task_sequence=str(document.get("task_sequence") or ""),
        added_at=document.get("added_at", EPOCH),
    )
