"""The services below /tms/db/ for templates."""

from tms_msg_db.srv import AddTemplate, GetTemplate, ListTemplates, RemoveTemplate

from tms_db import messages
from tms_db.answering import Answering
from tms_db.store import Db
from tms_db.task_text import MODELS
from tms_db.templates import Templates
from tms_runtime.app import App


class TemplateServices:
    """Stores, reads, lists and removes templates."""

    def __init__(self, app: App, db: Db) -> None:
        self._app, self._templates = app, Templates(db)
        self._models = {*MODELS, *app.site.models}

    def offer(self, answering: Answering) -> None:
        answering.quick(GetTemplate, "get_template", self.get)
        answering.quick(RemoveTemplate, "remove_template", self.remove)
        answering.slow(AddTemplate, "add_template", self.add)
        answering.slow(ListTemplates, "list_templates", self.list)

    def add(self, request: AddTemplate.Request, response: AddTemplate.Response) -> None:
        added = self._templates.add(
            request.template_name, request.task_sequence, request.description, self._models, request.replace
        )
        response.already_stored, response.replaced = added.already_stored, added.replaced
        response.model_name = added.model_name
        self._app.log.info("template_added", reason=request.template_name, replaced=added.replaced)

    def get(self, request: GetTemplate.Request, response: GetTemplate.Response) -> None:
        response.stored = messages.template(self._templates.get(request.template_name))

    def list(self, _: ListTemplates.Request, response: ListTemplates.Response) -> None:
        response.templates = [messages.template(one) for one in self._templates.all()]

    def remove(self, request: RemoveTemplate.Request, _: RemoveTemplate.Response) -> None:
        self._templates.remove(request.template_name)
        self._app.log.info("template_removed", reason=request.template_name)
