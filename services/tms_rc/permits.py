"""Receives the permits of all processes that may stand behind a goal of this machine."""

from collections.abc import Callable

from tms_machine.permit import RemotePermit
from tms_rc.chain import SCHEDULER
from tms_runtime.app import App
from tms_runtime.fence import Owner, parse


class Permits:
    """What each living process of the machine stands behind; `changed` is called on the executor thread."""

    def __init__(self, app: App, changed: Callable[[RemotePermit], None]) -> None:
        model = app.site.model_of(app.machine)
        names = [SCHEDULER, *(["rp"] if model.planner else []), *model.subtasks]
        self._remote: list[RemotePermit] = []

        def listen() -> None:
            self._remote = [RemotePermit(app.ros, app.pulse, app.machine, name, changed) for name in names]

        app.ros.on_executor(listen)  # no callback may come before all permits and their owner exist

    def held(self) -> dict[str, Owner]:
        """The living processes, and what each stands behind."""
        found = {permit.process: parse(permit.goal) for permit in self._remote if permit.alive}
        return {name: owner for name, owner in found.items() if owner is not None}

    def holder(self) -> str:
        """The name of the run that holds the machine, for people."""
        scheduler = self._remote[0] if self._remote else None
        return scheduler.holder if scheduler is not None and scheduler.alive else ""
