"""Process `tms:if_templates`: `/tms_db_reader_subtask`, from which schedulers of version 6 read templates.

Its type is TmsdbGetTask in the form of version 6 (tms_runtime/wire_form.py). `/tms_db_reader_task` is served by
`tms:db` in that of version 5, which understands requests of both: the number comes first.
"""

from typing import Any

from tms_msg_db.srv import TmsdbGetTask  # in the form of version 6
from tms_msg_if.srv import ReadTemplate

from tms_runtime.app import App

NAME, SOURCE = "tms_db_reader_subtask", "/tms/db/read_template"
LIMIT = 2.0  # s for the database; a scheduler of version 6 waits 3 s


def start(app: App) -> None:
    """Serve the templates of the database."""

    async def read(request: Any, response: Any) -> Any:
        """The template's text, "" if there is none."""
        wanted = ReadTemplate.Request(template_name=request.task_name)
        answer = await app.ros.call_async(ReadTemplate, SOURCE, wanted, LIMIT)
        if answer is None:
            app.log.warning("no_answer", service=SOURCE, template=request.task_name)
        else:
            response.task = answer.task_sequence
        return response

    app.ros.offer(TmsdbGetTask, NAME, read)
    app.ready_when(lambda: None)
