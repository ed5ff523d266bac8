"""The API's side of ROS: blocking calls for worker threads, and topics that update the board."""

from datetime import date, datetime
from functools import partial
from typing import TYPE_CHECKING, Any

from std_msgs.msg import String
from tms_msg_db.srv import (
    AddTask,
    AddTemplate,
    GetTask,
    GetTemplate,
    ListEvents,
    ListParameterHistory,
    ListParameters,
    ListRuns,
    ListTasks,
    ListTemplates,
    RemoveTask,
    SetParameter,
)
from tms_msg_ground.msg import SoilLoad
from tms_msg_host.msg import Processes
from tms_msg_host.srv import ControlProcess, ReadLog
from tms_msg_rc.msg import MachineState, StopReceipt
from tms_msg_rc.srv import StopMachine
from tms_msg_rp.srv import GetScene
from tms_msg_sp.msg import InputState, InputStates
from tms_msg_ts.msg import RunStates
from tms_msg_ts.srv import CheckTask

from tms_config.clock import monotonic
from tms_config.config import Site
from tms_config.processes import table
from tms_machine.places import PERIOD, Places
from tms_machine.values import to_parameters
from tms_reason import wire
from tms_reason.errors import TmsError
from tms_reason.reason import Reason
from tms_ros.node import Ros
from tms_schedulers.asking import of_first
from tms_schedulers.hearing import hear_runs
from tms_schedulers.names import schedulers
from tms_ur import alarm_topics, messages
from tms_ur.answers import checked
from tms_ur.area_client import check_areas, enable_areas
from tms_ur.board import Board
from tms_ur.data_models import Change, Record, Sensing
from tms_ur.ground_client import ground, ground_at
from tms_ur.ground_models import Ground
from tms_ur.machine_calls import MachineCalls
from tms_ur.models import AddedTemplate, Event, Host, Place, Run, Task, TaskText, Template
from tms_ur.place_client import PlaceClient
from tms_ur.planned_paths import PlannedPaths
from tms_ur.reasons import UnknownProcess
from tms_ur.recording_client import Asked, recording
from tms_ur.recording_models import Recording
from tms_ur.run_calls import CALL_LIMIT
from tms_ur.scene_models import Scene, scene
from tms_ur.watch_models import AreasChecked
from tms_ur.watching import Watching
from tms_ur.work_client import work
from tms_ur.work_models import Work
from tms_work.plan import Plan

if TYPE_CHECKING:
    from tms_ur.report_client import Wanted

PROCESS_LIMIT = 15.0  # s for a process to end and to be started


class SiteClient(MachineCalls):
    """The site as the API sees it."""

    def __init__(self, ros: Ros, site: Site) -> None:
        super().__init__(ros, site)
        self._machines = names = list(site.file.machines)
        self.board = Board(names)
        self._on_demand = {row.full for row in table(site) if not row.autostart}
        self.watching, self.shared = Watching(ros, site, self.board), PlaceClient(ros, self.board)
        self.palette = ""  # the nodes of trees, as XML; empty until the scheduler has told them
        self._inputs: tuple[list[InputState], float] | None = None  # read and replaced in one step
        self._places = Places(ros, {name: site.border(name) for name in names})
        self._ways = PlannedPaths(ros, names)
        for name in names:
            ros.subscribe(MachineState, f"/{name}/rc/state", self._on_machine, latched=True)
            ros.subscribe(StopReceipt, f"/{name}/rc/receipts", self._on_receipt, depth=20, latched=True)
            ros.prepare(StopMachine, f"/{name}/rc/stop")
            if site.file.ground is not None:
                ros.subscribe(SoilLoad, f"/{name}/soil_load", partial(self._on_load, name), latched=True)
        hear_runs(ros, site, self._on_runs)
        for one in schedulers(site):  # which all tell the same
            ros.subscribe(String, one.named("palette"), self._on_palette, latched=True)
        ros.subscribe(Processes, "/tms/host/processes", self._on_processes, depth=10, latched=True)
        ros.subscribe(InputStates, "/tms/sp/inputs", self._on_inputs, latched=True)
        ros.poll_in_thread(PERIOD, self._update_places, "places")
        alarm_topics.listen(ros, names, self.board, str(site.file.console.prometheus or ""))

    # topics

    def _on_machine(self, message: MachineState) -> None:
        self.board.put_machine(messages.machine(message))

    def _on_receipt(self, message: StopReceipt) -> None:
        self.board.put_stop(message.machine, messages.last_stop(message))

    def _on_load(self, name: str, message: SoilLoad) -> None:
        self.board.put_load(name, messages.load(message))

    def _on_runs(self, message: RunStates) -> None:
        runs = [messages.active_run(run) for run in message.runs]
        self.board.put_runs(runs, [messages.question(asked) for asked in message.questions])

    def _on_palette(self, message: String) -> None:
        self.palette = message.data

    def _on_processes(self, message: Processes) -> None:
        rows = [messages.process(row, row.name in self._on_demand) for row in message.processes]
        self.board.put_host(Host(name=message.host, processes=rows))

    def _on_inputs(self, message: InputStates) -> None:
        self._inputs = (list(message.inputs), monotonic())
        self.board.put_inputs({one.name: one.state for one in message.inputs})

    def _update_places(self) -> None:
        for name, way in self._ways.take():
            self.board.put_way(name, way)
        for name in self._places.take():
            seen = self._places.place(name)
            if seen is not None:
                place = Place(x=round(seen.x, 2), y=round(seen.y, 2), yaw=round(seen.yaw, 3))
                self.board.put_place(name, place, max(0.0, monotonic() - seen.received))

    def sensing(self) -> Sensing:
        """The sensing inputs as `tms:sp` reported them last."""
        reported = self._inputs
        if reported is None:
            return Sensing(age=None, inputs=[])
        since = monotonic() - reported[1]
        return Sensing(age=round(since, 1), inputs=[messages.sensing_input(one, since) for one in reported[0]])

    # the database

    def tasks(self) -> list[Task]:
        """All stored tasks."""
        return [Task(**messages.task(task)) for task in self._ask(ListTasks, "/tms/db/list_tasks").tasks]

    def task(self, task_id: int) -> TaskText:
        """One task with its tree."""
        task = self._ask(GetTask, "/tms/db/get_task", task_id=task_id).task
        return TaskText(**messages.task(task), xml=task.task_sequence)

    def add_task(self, xml: str, description: str) -> tuple[int, bool]:
        """Store a task; returns its number and whether the same text was stored already."""
        answer = self._ask(AddTask, "/tms/db/add_task", task_sequence=xml, description=description)
        return answer.task_id, answer.already_stored

    def remove_task(self, task_id: int) -> None:
        """Remove a task; its number becomes free."""
        self._ask(RemoveTask, "/tms/db/remove_task", task_id=task_id)

    def templates(self) -> list[Template]:
        """All stored templates."""
        return [messages.template(one) for one in self._ask(ListTemplates, "/tms/db/list_templates").templates]

    def template(self, name: str) -> str:
        """The tree of a template."""
        return self._ask(GetTemplate, "/tms/db/get_template", template_name=name).stored.task_sequence

    def add_template(self, name: str, xml: str, description: str, replace: bool) -> AddedTemplate:
        """Store a template under its name."""
        answer = self._ask(
            AddTemplate, "/tms/db/add_template", template_name=name, task_sequence=xml, description=description,
            replace=replace,
        )  # fmt: skip
        return AddedTemplate(already_stored=answer.already_stored, replaced=answer.replaced)

    def runs(self, limit: int) -> list[Run]:
        """The history, newest first."""
        return [messages.run(run) for run in self._ask(ListRuns, "/tms/db/list_runs", limit=limit).runs]

    def events(self, run_id: str, after: int, limit: int) -> list[Event]:
        """The events of a run with a number above `after`."""
        answer = self._ask(ListEvents, "/tms/db/list_events", run_id=run_id, after=after, limit=limit)
        return [messages.event(event) for event in answer.events]

    def recording(self, asked: Asked) -> Recording:
        """What machines told while runs were active."""
        return recording(self._ros, asked)

    def parameters(self, model_name: str) -> list[Record]:
        """Records of one machine; with an empty name, of all."""
        answer = self._ask(ListParameters, "/tms/db/list_parameters", model_name=model_name)
        return [messages.record(record) for record in answer.records]

    def parameter_history(self, model_name: str, record_name: str, limit: int) -> list[Change]:
        """The last changes of a record, newest first."""
        answer = self._ask(
            ListParameterHistory, "/tms/db/list_parameter_history", model_name=model_name, record_name=record_name,
            limit=limit,
        )  # fmt: skip
        return [messages.change(change) for change in answer.changes]

    def set_parameter(
        self, model_name: str, record_name: str, values: dict[str, Any], source: str, create: bool, kind: str
    ) -> None:
        """Set fields of one record in one atomic step."""
        self._ask(
            SetParameter, "/tms/db/set_parameter", model_name=model_name, record_name=record_name, type=kind,
            source=source, create=create, values=to_parameters(values),
        )  # fmt: skip

    # the scheduler

    def check_task(self, xml: str, motions: bool = True) -> tuple[list[Reason], list[Reason]]:
        """Errors and warnings of a tree, with or without its motions; nothing is stored and nothing runs."""
        asked = {"xml": xml, "without_motions": not motions}
        answer = of_first(self._site, lambda one: self._ask(CheckTask, one.named("check_task"), **asked))
        return list(map(wire.known, answer.errors)), list(map(wire.known, answer.warnings))

    # machines

    def check_areas(self, areas: dict[str, Any]) -> AreasChecked:
        """What would change if these areas were enabled; a TmsError says what is wrong with them."""
        return check_areas(self._ros, self._machines, self.watching.areas(), areas)

    def enable_areas(self, areas: dict[str, Any], shown: str, who: str) -> None:
        """Enable areas at every gateway; a TmsError says who refuses."""
        enable_areas(self._ros, self._machines, areas, shown, who)

    def scene(self, machine: str) -> Scene:
        """What the planner of a machine plans among now.

        Raises:
            TmsError: something of it is not known, or the planner is away.
        """
        return scene(machine, self._ask(GetScene, f"/{machine}/rp/get_scene"))

    def ground(self, cells: int) -> Ground:
        """The ground of the site in about so many cells at most; a TmsError says why it is not told."""
        return ground(self._ros, cells)

    def ground_at(self, time: datetime, cells: int) -> Ground:
        """The last ground that was kept until a time; a TmsError says why it is not told."""
        return ground_at(self._ros, time, cells)

    def work(self, day: date, plan: Plan | None) -> Work:
        """What was moved on a day; a TmsError says why it is not told."""
        return work(self._ros, day, plan)

    def report(self, wanted: "Wanted") -> bytes:
        """A daily report as a file; a TmsError says why it is not made."""
        from tms_ur.report_client import report  # loads plots and PDF

        return report(self._ros, wanted)

    # processes

    def restart(self, process: str) -> None:
        """Restart one process.

        Raises:
            TmsError: no host agent has it, or it cannot be started.
        """
        host = self._host_of(process)
        request = ControlProcess.Request(name=process, command="restart")
        checked(self._ros.call(ControlProcess, f"/tms/host/{host}/control", request, PROCESS_LIMIT))

    def log(self, process: str, size: int) -> str:
        """The end of a process's log."""
        request = ReadLog.Request(name=process, bytes=size)
        answer = self._ros.call(ReadLog, f"/tms/host/{self._host_of(process)}/log", request, CALL_LIMIT)
        return checked(answer).text

    def _host_of(self, process: str) -> str:
        host = self.board.host_of(process)
        if host is None:
            raise TmsError(UnknownProcess(process))
        return host
