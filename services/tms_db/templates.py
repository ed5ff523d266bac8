"""Templates in the database: trees that tasks call by their name (ExecuteSubtask), in the C++ system's collection.

A run keeps the texts that it began with, so a template may be changed at any time.
"""

import hashlib
import threading
from collections.abc import Collection
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from tms_config.clock import utc_now
from tms_db import task_text
from tms_db.reasons import BadTemplateName, TemplateExists, TemplateMissing
from tms_db.store import Db, errors
from tms_db.tasks import EPOCH
from tms_reason import names, xml_text
from tms_reason.errors import DbError, TmsError
from tms_reason.names import check_text

COLLECTION = "subtask"  # as the C++ system calls it
OLDEST_FIRST = [("_id", 1)]  # the C++ system reads the oldest of those with the same name


@dataclass(frozen=True)
class Template:
    """A stored template; `task_sequence` is empty in lists."""

    name: str
    model_name: str
    description: str
    task_sequence: str
    added_at: datetime


@dataclass(frozen=True)
class AddedTemplate:
    """What came of storing a template."""

    model_name: str
    already_stored: bool = False
    replaced: bool = False


class Templates:
    """The `subtask` collection."""

    def __init__(self, db: Db) -> None:
        self._templates = db[COLLECTION]
        self._adding = threading.Lock()

    def add(
        self, name: str, text: str, description: str = "", models: Collection[str] = task_text.MODELS,
        replace: bool = False,
    ) -> AddedTemplate:  # fmt: skip
        """Store a template's XML text under its name.

        Raises:
            TaskError: the text has not the form of a template.
            TmsError: the name or the description cannot be stored.
            DbError: TEMPLATE_EXISTS with another text, and it is not to be replaced; or the store is away.
        """
        new = document(name, text, description, models)
        model = str(new["model_name"])
        with self._adding, errors():
            stored = self._templates.find_one({"task_name": name}, sort=OLDEST_FIRST)
            if stored is None:
                self._templates.insert_one(new)
                return AddedTemplate(model)
            if same_text(stored, new):
                return AddedTemplate(model, already_stored=True)
            if not replace:
                raise DbError(TemplateExists(name))
            self._templates.replace_one({"_id": stored["_id"]}, new)
        return AddedTemplate(model, replaced=True)

    def get(self, name: str) -> Template:
        """The template of this name.

        Raises:
            DbError: TEMPLATE_MISSING.
        """
        with errors():
            found = self._templates.find_one({"task_name": name}, sort=OLDEST_FIRST)
        if found is None:
            raise DbError(TemplateMissing(name))
        return _template(found)

    def all(self) -> list[Template]:
        """All templates by name, without their texts."""
        with errors():
            found = self._templates.find({}, {"task_sequence": 0}).sort([("task_name", 1), *OLDEST_FIRST])
            by_name: dict[str, Template] = {}
            for stored in found:
                by_name.setdefault(str(stored.get("task_name")), _template(stored))
        return list(by_name.values())

    def remove(self, name: str) -> None:
        """Take a template away.

        Raises:
            DbError: TEMPLATE_MISSING.
        """
        with errors():
            if not self._templates.delete_many({"task_name": name}).deleted_count:
                raise DbError(TemplateMissing(name))


def document(name: str, text: str, description: str, models: Collection[str]) -> dict[str, Any]:
    """The document of a template, with its fields checked.

    Raises:
        TaskError, TmsError: as `Templates.add`.
    """
    if (why := names.name_flaw(name)) is not None:
        raise TmsError(BadTemplateName(name[:40], why))
    check_text("description", description)
    essence = task_text.essence(text)
    xml_text.template_top(xml_text.elements(xml_text.decode(text), comments=False))
    return {
        "task_name": name,
        "type": "subtask",
        "model_name": task_text.main_model(essence, models),
        "description": description.strip() or f"{name}.xml",  # as the C++ system's generator has it
        "task_sequence": text.removeprefix("\ufeff"),  # unchanged, so that line numbers are those of the file
        "text_sha256": hashlib.sha256(essence.encode()).hexdigest(),
        "added_at": utc_now(),
    }


def same_text(stored: dict[str, Any], new: dict[str, Any]) -> bool:
    """Whether two documents hold the same tree; those of the C++ system have no hash."""
    if "text_sha256" in stored:
        return bool(stored["text_sha256"] == new["text_sha256"])
    return hashlib.sha256(str(stored.get("task_sequence")).encode()).hexdigest() == str(new["text_sha256"])


def _template(found: dict[str, Any]) -> Template:
    return Template(
        name=str(found.get("task_name") or ""),
        model_name=str(found.get("model_name") or ""),
        description=str(found.get("description") or ""),
        task_sequence=str(found.get("task_sequence") or ""),
        added_at=found.get("added_at", EPOCH),
    )
