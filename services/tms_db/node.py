"""`tms:db`: serves tasks, parameters and history as ROS services, records runs; stays up while the store is away."""

from tms_msg_db.srv import (
    AddTask,
    GetTask,
    ListEvents,
    ListRuns,
    ListTasks,
    RemoveTask,
    WriteJournal,
    WriteMachineStates,
)

from tms_db import messages, store, store_address
from tms_db.answering import Answering
from tms_db.connection import StoreConnection
from tms_db.cpp_services import CppServices
from tms_db.cycles import COLLECTION, Cycles
from tms_db.ground_services import GroundServices
from tms_db.history import History
from tms_db.machine_leases import MachineLeases
from tms_db.machine_states import MachineStates
from tms_db.parameter_services import ParameterServices
from tms_db.places import PlaceServices
from tms_db.recorder import Recorder
from tms_db.recording_services import RecordingServices
from tms_db.retention import Retention
from tms_db.task_text import MODELS
from tms_db.tasks import Tasks
from tms_db.template_services import TemplateServices
from tms_db.terrain_services import TerrainServices
from tms_db.work_services import WorkServices
from tms_runtime.app import App


class TaskServices:
    """Tasks and history."""

    def __init__(self, app: App, db: store.Db) -> None:
        self._app = app
        self._tasks, self._history = Tasks(db), History(db)
        self._states, self._cycles = MachineStates(db), Cycles(db)
        self._models = {*MODELS, *app.site.models}

    def offer(self, answering: Answering) -> None:
        answering.quick(GetTask, "get_task", self.get_task)
        answering.quick(RemoveTask, "remove_task", self.remove_task)
        # In threads of their own: a leaf that reads its record must not wait for the events of the leaf before.
        answering.slow(WriteJournal, "write_journal", self.write_journal)
        answering.slow(WriteMachineStates, "write_machine_states", self.write_machine_states)
        answering.slow(AddTask, "add_task", self.add_task)
        answering.slow(ListTasks, "list_tasks", self.list_tasks)
        answering.slow(ListRuns, "list_runs", self.list_runs)
        answering.slow(ListEvents, "list_events", self.list_events)

    def add_task(self, request: AddTask.Request, response: AddTask.Response) -> None:
        added = self._tasks.add(request.task_sequence, request.description, self._models)
        response.task_id, response.model_name = added.task_id, added.model_name
        response.already_stored = added.already_stored
        self._app.log.info("task_added", task=added.task_id, stored_before=added.already_stored)

    def get_task(self, request: GetTask.Request, response: GetTask.Response) -> None:
        response.task = messages.task(self._tasks.get(request.task_id))

    def list_tasks(self, _: ListTasks.Request, response: ListTasks.Response) -> None:
        response.tasks = [messages.task(task) for task in self._tasks.all()]

    def remove_task(self, request: RemoveTask.Request, _: RemoveTask.Response) -> None:
        self._tasks.remove(request.task_id)
        self._app.log.info("task_removed", task=request.task_id)

    def write_journal(self, request: WriteJournal.Request, _: WriteJournal.Response) -> None:
        runs = [messages.stored_run(run) for run in request.runs]
        self._history.write(runs, [messages.stored_event(event) for event in request.events])

    def list_runs(self, request: ListRuns.Request, response: ListRuns.Response) -> None:
        response.runs = [messages.run(run) for run in self._history.runs(request.limit)]

    def list_events(self, request: ListEvents.Request, response: ListEvents.Response) -> None:
        found = self._history.events(request.run_id, request.after, request.limit)
        response.events = [messages.event(event) for event in found]

    def write_machine_states(self, request: WriteMachineStates.Request, _: WriteMachineStates.Response) -> None:
        """States of machines, and cycles of their work: both are documents that tell of a machine."""
        cycles = [messages.cycle(one) for one in request.states if one.collection == COLLECTION]
        states = [messages.machine_state(one) for one in request.states if one.collection != COLLECTION]
        self._cycles.write(cycles)
        self._states.write(states)


def start(app: App) -> None:
    """Serve the services; the connection to the store is made in the background.

    Raises:
        ConfigError: the store's address is wrong.
    """
    db = store.connect(store_address.uri(app.site), app.site.file.store.database)
    connection = StoreConnection(db, store.redact(store_address.uri(app.site)), app.log)
    app.ready_when(connection.unready)
    app.on_stop(connection.stop)
    answering = Answering(app, connection)
    TaskServices(app, db).offer(answering)
    TemplateServices(app, db).offer(answering)
    ParameterServices(app, db, connection).offer(answering)
    CppServices(app, db, connection).offer()
    TerrainServices(app, db, connection).offer()
    GroundServices(app, db).offer(answering)
    PlaceServices(app, db, connection).offer()
    MachineLeases(app, db, connection).offer()
    RecordingServices(db).offer(answering)
    WorkServices(db).offer(answering)
    recorder = Recorder(app, db, connection)
    app.on_stop(recorder.stop)
    recorder.start()
    retention = Retention(db, connection, app.site.file.store, app.log)
    app.on_stop(retention.stop)
    retention.start()
    connection.start()
