"""The C++ system's services under their names, for its nodes and tools; their types have no error codes."""

import json
from collections.abc import Callable

from tms_msg_db.msg import Tmsdb
from tms_msg_db.srv import TmsdbGetData, TmsdbGetTask
from tms_msg_if.srv import ReadRecords, ReadTemplate

from tms_db import store
from tms_db.connection import StoreConnection
from tms_db.parameters import Parameters
from tms_db.records import Document
from tms_db.tasks import Tasks
from tms_db.templates import Templates
from tms_reason.errors import TmsError
from tms_runtime.app import App

READER = "tms_db_param_reader"
POSE = ("x", "y", "z", "qx", "qy", "qz", "qw", "Release_Count")
NOT_FLAGS = {"_id", "type", "record_name", "updated_at", "source"}


class CppServices:
    """Answers as the C++ readers do, except that no document makes them crash."""

    def __init__(self, app: App, db: store.Db, connection: StoreConnection) -> None:
        self._app, self._connection = app, connection
        self._tasks, self._parameters, self._templates = Tasks(db), Parameters(db), Templates(db)

    def offer(self) -> None:
        self._app.ros.offer(TmsdbGetTask, "tms_db_reader_task", self.get_task)
        if self._app.site.file.forms.TmsdbGetData is None:  # else `tms:if_readers` serves it, in that form
            self._app.ros.offer(TmsdbGetData, READER, self.get_data)
        self._app.ros.offer(ReadRecords, "/tms/db/read_records", self.read_records)
        self._app.ros.offer(ReadTemplate, "/tms/db/read_template", self.read_template)

    def get_task(self, request: TmsdbGetTask.Request, response: TmsdbGetTask.Response) -> TmsdbGetTask.Response:
        """The task's text, "" if there is none."""

        def read() -> None:
            response.task = self._tasks.get(request.task_id).task_sequence

        self._try("tms_db_reader_task", read)
        return response

    def read_template(self, request: ReadTemplate.Request, response: ReadTemplate.Response) -> ReadTemplate.Response:
        """The template's text for `tms:if_readers`, "" if there is none."""

        def read() -> None:
            response.task_sequence = self._templates.get(request.template_name).task_sequence

        self._try("read_template", read)
        return response

    def get_data(self, request: TmsdbGetData.Request, response: TmsdbGetData.Response) -> TmsdbGetData.Response:
        """Records by name as JSON; those that are not there are left out."""

        def read() -> None:
            for name in [request.name] if request.name else request.recordnames:
                for first in self._found(name):
                    kind, text = _told(first, request.flgorparam)
                    response.tmsdbs.append(Tmsdb(type=kind, name=name, msg=text))

        self._try(READER, read)
        return response

    def read_records(self, request: ReadRecords.Request, response: ReadRecords.Response) -> ReadRecords.Response:
        """The same for `tms:if_readers`."""

        def read() -> None:
            for name in request.record_names:
                for first in self._found(name):
                    kind, text = _told(first, request.what)
                    response.found.append(name)
                    response.types.append(kind)
                    response.texts.append(text)

        self._try("read_records", read)
        return response

    def _try(self, service: str, read: Callable[[], None]) -> None:
        """Read for a service; what goes wrong is logged, since its answer has no place for it."""
        try:
            with self._connection.use():
                read()
        except TmsError as error:
            self._app.log.warning("refused", service=service, code=error.code, reason=error.reason)

    def _found(self, name: str) -> list[Document]:
        """The first record of this name, or none: the C++ reader ignores model_name, too."""
        documents = self._parameters.named(name)
        if not documents:
            self._app.log.warning("refused", service=READER, reason="there is no such record", record=name)
        return documents[:1]


def _told(document: Document, what: str) -> tuple[str, str]:
    """The type of a record, and what its readers get as JSON."""
    return str(document.get("type") or ""), json.dumps(content(document, what), ensure_ascii=False, default=str)


def content(document: Document, what: str) -> Document:
    """What a reader of `what` ("param" or "flg") gets; a missing pose field is an empty list, as it is today."""
    if what == "param":
        return {key: document.get(key, []) for key in POSE}
    return {key: value for key, value in document.items() if key not in NOT_FLAGS}
