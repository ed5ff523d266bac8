"""Writes what an import has planned: all of it, or nothing."""

from tms_db.import_plan import Plan
from tms_db.reasons import ImportedInPart
from tms_db.store import Db, errors
from tms_reason.errors import DbError


def write(db: Db, plan: Plan) -> None:
    """Write the documents of a plan; when one of them cannot be written, take back those before it.

    Raises:
        DbError: the store is away, or another process has stored a task meanwhile. Nothing is imported then, unless
            the message says that the store was lost for the way back, too.
    """
    try:
        with errors():
            for collection, documents in plan.inserts.items():
                db[collection].insert_many(documents)
            for collection, old, new in plan.replaced:
                db[collection].replace_one({"_id": old["_id"]}, new)
    except BaseException as error:  # also Ctrl-C
        try:
            _take_back(db, plan)
        except DbError as lost:
            why = error.reason if isinstance(error, DbError) else lost.reason
            raise DbError(ImportedInPart(why), lost.code) from error
        raise


def _take_back(db: Db, plan: Plan) -> None:
    with errors():
        for collection, documents in plan.inserts.items():
            db[collection].delete_many({"_id": {"$in": [document["_id"] for document in documents]}})
        for collection, old, _ in plan.replaced:
            db[collection].replace_one({"_id": old["_id"]}, old)
