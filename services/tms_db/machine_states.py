"""Where machines were: the collections machine_pose and machine_joints of the C++ system, kept for a while."""

import json
from collections.abc import Sequence
from datetime import datetime
from typing import Any

from tms_db.reasons import NoCollection, StateNoJson, StateNoObject
from tms_db.records import Document, bad
from tms_db.store import Db, errors

MACHINE = 3012  # the C++ system's id for all states of machines
COLLECTIONS = ("machine_pose", "machine_joints")


class MachineStates:
    """The collections of machine states, as the C++ system keeps them."""

    def __init__(self, db: Db) -> None:
        self._db = db

    def write(self, documents: Sequence[Document]) -> None:
        """Add states.

        Raises:
            DbError: the store is away.
        """
        for collection in COLLECTIONS:
            wanted = [document for document in documents if document["type"] == collection]
            if wanted:
                with errors():
                    self._db[collection].insert_many(wanted)


def envelope(collection: str, machine: str, stamp: datetime, text: str) -> Document:
    """One state in the form that the C++ system writes.

    Raises:
        DbError: BAD_RECORD; there is no such collection, or the text is no JSON object.
    """
    if collection not in COLLECTIONS:
        raise bad(NoCollection(collection, tuple(COLLECTIONS)))
    message = document_of(collection, machine, text)
    return {"time": stamp.isoformat(), "type": collection, "id": MACHINE, "name": machine, "msg": message}


def document_of(collection: str, machine: str, text: str) -> Document:
    """The document in the text of a state.

    Raises:
        DbError: BAD_RECORD; the text is no JSON object.
    """
    try:
        found: Any = json.loads(text)
    except json.JSONDecodeError as error:
        raise bad(StateNoJson(collection, machine, error.msg)) from error
    if not isinstance(found, dict):
        raise bad(StateNoObject(collection, machine))
    return found
