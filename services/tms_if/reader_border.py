"""Process `tms:if_readers`: what nodes of the C++ system's version 6 read of the database.

`/tms_db_reader_subtask` gives templates, in version 6's form of TmsdbGetTask. `/tms_db_reader_task` is served by
`tms:db` in that of version 5, which understands requests of both: the number comes first. Records are read in the form
of TmsdbGetData that the site file names (tms_runtime/wire_form.py); where it names none, `tms:db` serves them as
version 5 does.
"""

import json
from collections.abc import Mapping
from typing import Any

from geometry_msgs.msg import Point, Pose, PoseStamped, Quaternion
from nav_msgs.msg import Path
from tms_msg_db.msg import Tmsdb  # these three in the forms of version 6
from tms_msg_db.srv import TmsdbGetData, TmsdbGetTask
from tms_msg_if.srv import ReadRecords, ReadTemplate

from tms_interfaces.generated import Req, Res, ServiceType
from tms_machine.frames import MAP
from tms_runtime.app import App

TEMPLATES, RECORDS = "tms_db_reader_subtask", "tms_db_param_reader"
RECORDS_BY_TYPE = "tms_db_reader"  # reads any collection there, and here only that of records
COLLECTION = "parameter"
PLAN, POSE = "plan", "param"  # values of param_type
FIELDS = ("x", "y", "z", "qx", "qy", "qz", "qw")  # of a path
LIMIT = 2.0  # s for the database; a scheduler of version 6 waits 3 s
THEIRS: Any = Tmsdb  # mypy knows the fields of version 5 only


def start(app: App) -> None:
    """Serve what their nodes read."""
    border = ReaderBorder(app)
    app.ros.offer(TmsdbGetTask, TEMPLATES, border.template)
    if app.site.file.forms.TmsdbGetData is not None:
        app.ros.offer(TmsdbGetData, RECORDS, border.records)
        app.ros.offer(TmsdbGetData, RECORDS_BY_TYPE, border.records)
    app.ready_when(lambda: None)
    app.log.info("serving", form=app.process.form)


class ReaderBorder:
    """Answers from the database; what it does not have, or while it is away, is an empty answer."""

    def __init__(self, app: App) -> None:
        self._app = app

    async def template(self, request: Any, response: Any) -> Any:
        """The text of a template."""
        answer = await self._ask(ReadTemplate, "read_template", ReadTemplate.Request(template_name=request.task_name))
        if answer is not None:
            response.task = answer.task_sequence
        return response

    async def records(self, request: Any, response: Any) -> Any:
        """Records by name as JSON, with a path where a plan is asked for."""
        if request.type not in ("", COLLECTION):
            self._app.log.warning("refused", service=RECORDS_BY_TYPE, collection=request.type)
            return response
        names, what = [request.name] if request.name else list(request.recordnames), wanted(request)
        asked = ReadRecords.Request(record_names=names, what=POSE if what == PLAN else what)
        answer = await self._ask(ReadRecords, "read_records", asked)
        if answer is not None:
            for name, kind, text in zip(answer.found, answer.types, answer.texts, strict=True):
                told = THEIRS(type=kind, name=name, msg=text)
                if what == PLAN:
                    told.plan = path_of(json.loads(text))
                response.tmsdbs.append(told)
        return response

    async def _ask(self, kind: ServiceType[Req, Res], service: str, request: Req) -> Res | None:
        answer = await self._app.ros.call_async(kind, f"/tms/db/{service}", request, LIMIT)
        if answer is None:
            self._app.log.warning("no_answer", service=service)
        return answer


def wanted(request: Any) -> str:
    """What a request asks of a record: plan, param or flg; `flgorparam` counts where `param_type` is empty."""
    return str(request.param_type or getattr(request, "flgorparam", ""))


def path_of(fields: Mapping[str, Any]) -> Path:
    """The path in the fields of a record; empty where it has none. A number is a list of one, as in the C++ system."""
    path = Path()
    path.header.frame_id = MAP
    try:
        rows = list(zip(*(map(float, _list(fields[name])) for name in FIELDS), strict=False))
    except (TypeError, ValueError):
        return path
    for x, y, z, qx, qy, qz, qw in rows:
        stamped = PoseStamped(pose=Pose(position=Point(x=x, y=y, z=z), orientation=Quaternion(x=qx, y=qy, z=qz, w=qw)))
        stamped.header.frame_id = MAP
        path.poses.append(stamped)
    return path


def _list(value: Any) -> list[Any]:
    return value if isinstance(value, list) else [value]
