"""Receives the permits of all processes that may stand behind a goal of this machine."""

from collections.abc import Callable

from tms_machine.permit import Link
from tms_rc.chain import SCHEDULER
from tms_runtime.app import App
from tms_runtime.fence import Owner, parse


class Permits:
    """What each living process of the machine stands behind; `changed` is called on the executor thread."""

    def __init__(self, app: App, changed: Callable[[Link], None]) -> None:
        model = app.site.model_of(app.machine)
        names = [SCHEDULER, *(["rp"] if model.planner else []), *model.subtasks]
        self._links: list[Link] = []

        def listen() -> None:
            self._links = [Link(app.ros, app.pulse, app.machine, name, changed) for name in names]

        app.ros.on_executor(listen)  # no callback may come before all links and their owner exist

    def held(self) -> dict[str, Owner]:
        """The living processes, and what each stands behind."""
        found = {link.process: parse(link.goal) for link in self._links if link.alive}
        return {name: owner for name, owner in found.items() if owner is not None}

    def holder(self) -> str:
        """The name of the run that holds the machine, for people."""
        scheduler = self._links[0] if self._links else None
        return scheduler.holder if scheduler is not None and scheduler.alive else ""
