"""A site that a test makes up, behind a real console: two machines, no ROS."""

import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import timedelta
from pathlib import Path
from typing import Any

import yaml

from conftest import site_data
from tms_config.clock import utc_now
from tms_config.config import load_site
from tms_reason.errors import TmsError
from tms_reason.reason import Foreign
from tms_ur.access import Access
from tms_ur.api import create_app
from tms_ur.board import Board
from tms_ur.connections import Listener
from tms_ur.data_models import Change, Record
from tms_ur.models import ActiveRun, AddedTemplate, Event, Machine, Rearmed, Run
from tms_ur.node import Server
from unit.tms_ur.fakes import NOON, FakeAudit, FakeSiteClient

MACHINES = ("zx200", "ic120")
RUN = ActiveRun(run_id="r-1", task_id=4, state="running", machines=["zx200"])


def shape(branches: int, leaves: int) -> dict[str, list[str]]:
    """The values of a journal's tree: a root with branches of equally many leaves."""
    paths = ["0"]
    for branch in range(branches):
        paths += [f"0.{branch}", *(f"0.{branch}.{leaf}" for leaf in range(leaves))]
    deep = [path.count(".") == 2 for path in paths]
    types = ["LeafNodeZx200" if leaf else "Sequence" for leaf in deep]
    goals = [f'model_name="zx200" subtask_name="dig" record_name="R{path}"' for path in paths]
    ports = [goal if leaf else "" for goal, leaf in zip(goals, deep, strict=True)]
    kinds = ["action" if leaf else "control" for leaf in deep]
    return {"paths": paths, "names": types, "types": types, "kinds": kinds, "ports": ports}


def log_line(second: float, level: str = "INFO", text: str = "event=begun") -> str:
    """A line of a process's log, some seconds after noon."""
    there = (NOON + timedelta(seconds=second)).astimezone().replace(tzinfo=None)
    return f"{there.isoformat(timespec='microseconds')} {level} {text}\n"


class Yard(FakeSiteClient):
    """Two machines, and a clock that the test turns."""

    def __init__(self, models: dict[str, str] | None = None, **site: object) -> None:
        """`models`: of its machines, by their names; `site`: what else its file says."""
        super().__init__()
        self.models = models or {name: name for name in MACHINES}
        self.site = site
        self.now = 100.0
        self.board = Board(self.models, lambda: self.now)
        self.slow = threading.Event()  # until then zx200 does not answer
        self.journals: dict[str, list[Event]] = {}
        self.taken = False  # whether the template has another text

    def receive(self, **facts: Any) -> None:
        """Both machines and the scheduler."""
        for name in self.models:
            self.board.put_machine(Machine(name=name, state="standing", joint_age=0.1, **facts))
        self.board.put_runs([RUN])

    def rearm(self, machine: str, token: str) -> Rearmed:
        if machine == "zx200":
            self.slow.wait(60)
        return super().rearm(machine, token)

    def add_template(self, name: str, xml: str, description: str, replace: bool) -> AddedTemplate:
        if self.taken and not replace:
            raise TmsError(Foreign("it has another text"), "TEMPLATE_EXISTS")
        return super().add_template(name, xml, description, replace)

    def runs(self, limit: int) -> list[Run]:
        facts = {"task_id": 4, "description": "", "machines": [], "started_at": NOON, "ended_at": NOON}
        return [Run(run_id=name, state="abandoned", **facts, values={"nodes": 3}) for name in self.journals]

    def events(self, run_id: str, after: int, limit: int) -> list[Event]:
        if not self.journals:
            return super().events(run_id, after, limit)
        return self.journals.get(run_id, [])[after : after + limit]

    def parameters(self, model_name: str) -> list[Record]:
        self._called("parameters", model_name)
        written = utc_now() - timedelta(seconds=30)
        facts = {"type": "static", "description": "", "source": "cli", "updated_at": written, "values": {"d": 1.0}}
        return [Record(model_name="zx200", record_name="pose", **facts)]

    def parameter_history(self, model_name: str, record_name: str, limit: int) -> list[Change]:
        return [Change(stamp=NOON, source="cli", values={"d": 1.0})]


@contextmanager
def serving(yard: Yard, folder: Path, users: Path | None = None) -> Iterator[str]:
    """Serve its console; gives the address. `users`: a file of those who log in, else everybody is an admin."""
    file = folder / "site.yaml"
    machines = {name: {"model": model} for name, model in yard.models.items()}
    file.write_text(yaml.safe_dump(site_data(42, 20000, machines=machines, **yard.site)))
    listener = Listener(fileno=socket.create_server(("127.0.0.1", 0)).detach())
    application = create_app(yard, FakeAudit(), load_site(str(file)), Access(users))  # type: ignore[arg-type]
    server = Server(application, listener, None)
    try:
        yield f"http://127.0.0.1:{listener.getsockname()[1]}"
    finally:
        yard.slow.set()
        yard.board.close()
        server.stop()
