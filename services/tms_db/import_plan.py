"""What an import will write: every tree and record of a folder is compared with the database, and nothing is changed.

Documents of a dump stay as they are, as after `tms db restore`; only a task's number may change.
"""

import hashlib
from collections.abc import Collection, Iterator
from dataclasses import dataclass, field
from itertools import count
from typing import Any

from bson import ObjectId

from tms_config.clock import utc_now
from tms_db import tasks, templates
from tms_db.import_source import FoundRecord, Source, Tree
from tms_db.parameters import Parameters, key_of, same
from tms_db.reasons import (
    FieldAsItIs,
    KeyIsNoText,
    NoTaskText,
    NumberTaken,
    RecordDiffers,
    RecordSplit,
    RecordTwice,
    TemplateExists,
    TemplateTwice,
    TypeAsItIs,
)
from tms_db.records import (
    RESERVED,
    TYPES,
    Document,
    bad,
    check_key,
    check_line,
    check_max_age,
    check_type,
    check_values,
    title,
)
from tms_db.store import Db, errors
from tms_reason import xml_text
from tms_reason.errors import DbError, TaskError, TmsError
from tms_reason.reason import Reason

NEW, THERE, REFUSED, OTHER = "new", "there", "refused", "other"
SOURCE = "import"  # of records from files
WRITTEN = frozenset({"updated_at", "source", "timestamps"})  # fields that tell when a record was written


@dataclass
class Item:
    """One tree, record or file of the folder."""

    kind: str  # task, template or record; empty for a file that is none
    place: str
    name: str = ""  # number of the task, name of the template or record
    state: str = NEW
    why: Reason | None = None  # of one that is refused, or is no tree or record
    warnings: list[Reason] = field(default_factory=list)
    text: str = ""  # of a tree


@dataclass
class Plan:
    """The report, and what is to be written."""

    items: list[Item] = field(default_factory=list)
    inserts: dict[str, list[Document]] = field(default_factory=dict)  # collection -> documents, each with its _id
    replaced: list[tuple[str, Document, Document]] = field(default_factory=list)  # collection, old, new

    def count(self, state: str) -> int:
        return sum(1 for item in self.items if item.state == state)

    def insert(self, collection: str, document: Document) -> None:
        self.inserts.setdefault(collection, []).append({"_id": ObjectId(), **document})


def plan(db: Db, source: Source, models: Collection[str], *, replace: bool = False) -> Plan:
    """Compare a folder with the database.

    replace: templates and records that are there with another content become those of the folder

    Raises:
        DbError: the store is away.
    """
    planner = _Planner(db, models, replace)
    called = set().union(*(_calls(tree.text) for tree in source.trees)) if source.trees else set()
    for tree in sorted(source.trees, key=lambda tree: tree.document is None):  # those of a dump have their numbers
        kind = tree.kind or ("template" if tree.name in called or xml_text.OPEN_KEY.search(tree.text) else "task")
        planner.take(Item(kind, tree.place, text=tree.text), tree)
    for record in source.records:
        planner.take(Item("record", record.place), record)
    for state, found in ((REFUSED, source.refused), (OTHER, source.others)):
        planner.plan.items += [Item("", one.place, state=state, why=one.why) for one in found]
    return planner.plan


def _calls(text: str) -> set[str]:
    """The templates that a tree calls."""
    try:
        root = xml_text.elements(xml_text.decode(text), comments=False)
    except TaskError:
        return set()
    return {str(element.get("subtask_name")) for element in root.iter("*") if xml_text.is_call(element)}


class _Planner:
    def __init__(self, db: Db, models: Collection[str], replace: bool) -> None:
        self.plan, self._db, self._models, self._replace = Plan(), db, models, replace
        self._parameters = Parameters(db)
        with errors():
            stored = list(db["task"].find({}, {"task_id": 1, "text_sha256": 1, "task_sequence": 1}))
        self._tasks = {_digest(one): one.get("task_id") for one in stored}
        self._numbers = {one.get("task_id") for one in stored}
        self._templates: dict[str, Document] = {}  # of this import
        self._records: dict[tuple[str, str], Document] = {}  # of this import

    def take(self, item: Item, found: Tree | FoundRecord) -> None:
        """Plan one thing; a refusal goes into the report."""
        self.plan.items.append(item)
        try:
            if isinstance(found, FoundRecord):
                self._record(item, found)
            elif item.kind == "task":
                self._task(item, found)
            else:
                self._template(item, found)
        except TmsError as error:
            if error.code in ("STORE_DOWN", "DB_FAILED"):
                raise
            item.state, item.why = REFUSED, error.reason

    def _task(self, item: Item, tree: Tree) -> None:
        new = tasks.document(_text(tree), tree.place if tree.document is None else "", self._models)
        digest = str(new["text_sha256"])
        if digest in self._tasks:
            item.name, item.state = str(self._tasks[digest]), THERE
            return
        wanted = tree.document.get("task_id") if tree.document is not None else None
        wanted = int(wanted) if isinstance(wanted, float) and wanted.is_integer() else wanted  # as Mongo's shell has it
        number = next(one for one in count(1) if one not in self._numbers)
        if isinstance(wanted, int) and 0 < wanted <= tasks.MAX_TASK_ID:
            if wanted in self._numbers:
                item.warnings.append(NumberTaken(wanted, number))
            else:
                number = wanted
        self._tasks[digest] = number
        self._numbers.add(number)
        item.name = str(number)
        whole = {**new, "added_at": utc_now()} if tree.document is None else tree.document
        self.plan.insert("task", {**whole, "task_id": number})

    def _template(self, item: Item, tree: Tree) -> None:
        item.name = tree.name
        new = templates.document(tree.name, _text(tree), "", self._models)
        earlier = self._templates.get(tree.name)
        if earlier is not None and not templates.same_text(earlier, new):
            raise TmsError(TemplateTwice(tree.name))
        with errors():
            stored = self._db[templates.COLLECTION].find_one({"task_name": tree.name}, sort=templates.OLDEST_FIRST)
        if earlier is not None or (stored is not None and templates.same_text(stored, new)):
            item.state = THERE
            return
        self._templates[tree.name] = new
        whole = new if tree.document is None else tree.document
        if stored is None:
            self.plan.insert(templates.COLLECTION, whole)
        elif self._replace:
            self.plan.replaced.append((templates.COLLECTION, stored, {**whole, "_id": stored["_id"]}))
        else:
            raise DbError(TemplateExists(tree.name))

    def _record(self, item: Item, found: FoundRecord) -> None:
        models = found.document.get("model_name") or ""
        several = [str(one) for one in models] if isinstance(models, list) else [str(models)]
        name = found.document.get("record_name")
        item.name = ", ".join(title(model, str(name or "")) for model in several)
        if len(several) > 1:
            item.warnings.append(RecordSplit(tuple(several)))
        item.warnings += _as_they_are(item.name, found.document)
        states = {self._one_record(model, str(name or ""), found) for model in several}
        item.state = NEW if NEW in states else THERE

    def _one_record(self, model: str, name: str, found: FoundRecord) -> str:
        check_key(model, name)
        fields = {key: value for key, value in found.document.items() if key not in ("model_name", "record_name")}
        if not found.dumped:
            fields = {"type": "dynamic", "description": "", **fields, "updated_at": utc_now(), "source": SOURCE}
            _check_head(title(model, name), fields)
        new = {**({"model_name": model} if model else {}), "record_name": name, **fields}
        earlier = self._records.get((model, name))
        if earlier is not None and not _says(earlier, new):
            raise TmsError(RecordTwice(found.place, title(model, name)))
        with errors():
            stored = self._db["parameter"].find_one(key_of(model, name))
        if earlier is not None or (stored is not None and _says(stored, new)):
            return THERE
        self._records[model, name] = new
        if stored is None:
            self.plan.insert("parameter", new)
        elif self._replace:
            with errors():
                self._parameters.refuse_in_use(model, name, stored)
            self.plan.replaced.append(("parameter", stored, {**stored, **new}))
        else:
            raise DbError(RecordDiffers(title(model, name)))
        return NEW


def _check_head(where: str, fields: Document) -> None:
    """Refuse what a person has written wrong in a file; documents of a dump are as they are."""
    for key in ("type", "description"):
        if not isinstance(fields[key], str):
            raise bad(KeyIsNoText(where, key, repr(fields[key])))
    check_type(where, fields["type"])
    check_line(where, "description", fields["description"])
    check_max_age(where, fields.get("max_age", 0.0), fields["type"])


def _text(tree: Tree) -> str:
    if not tree.text:
        raise TaskError(NoTaskText(), TaskError.code)
    return tree.text


def _digest(stored: Document) -> str:
    """What identifies a stored task; the C++ system stores the essence itself."""
    own = stored.get("text_sha256")
    return str(own) if own else hashlib.sha256(str(stored.get("task_sequence")).encode()).hexdigest()


def _as_they_are(where: str, document: Document) -> Iterator[Reason]:
    """Warnings of what our processes do not read: nested values, binary ones, types of the C++ system."""
    for name, value in document.items():
        if name not in RESERVED:
            try:
                check_values(where, {name: value})
            except DbError as error:
                yield FieldAsItIs(error.reason)
    kind = str(document.get("type") or "dynamic")
    if kind not in TYPES:
        yield TypeAsItIs(kind)


def _says(stored: Document, new: Document) -> bool:
    """Whether a stored record has the fields of a new one already."""
    wanted: dict[str, Any] = {name: value for name, value in new.items() if name not in WRITTEN}
    return all(name in stored and same(stored[name], value) for name, value in wanted.items() if value != "")
