"""What runs want of shared places, told to their keeper in order, and again until it answers.

So what a run has freed is free, though the keeper or the database was away meanwhile.
"""

from collections.abc import Callable, Iterable
from queue import SimpleQueue

from tms_msg_areas.srv import AskPlaces

from tms_kit.place_holding import ASK, ASK_AGAIN, ASK_LIMIT
from tms_kit.site_places import SitePlaces
from tms_machine.asking import ask
from tms_places.reasons import NoPlace
from tms_reason.errors import RosError
from tms_reason.reason import Reason
from tms_runtime.app import App
from tms_ts.flags import Answer

LOOK = 0.05  # s between looks whether something is to be told


class PlaceRequests:
    """All requests of this scheduler."""

    def __init__(self, app: App, recorded: Callable[[], Iterable[str]], own: Callable[[str], bool]) -> None:
        """`recorded`: own runs that have not ended, or whose end is to be told yet (it may wait for the disk).

        `own`: whether a run is this scheduler's.
        """
        self._app, self._recorded, self._own = app, recorded, own
        self._looked = False  # for runs that an earlier scheduler has left
        self._runs: set[str] = set()  # that have wanted places before that
        self._waiting: SimpleQueue[tuple[AskPlaces.Request, Answer[None], Callable[[], None]]] = SimpleQueue()
        self._wakes: list[Callable[[], None]] = []  # of runs that look at places
        self.site = SitePlaces(app.ros, self._changed)
        app.ros.poll_in_thread(LOOK, self._send, "places")

    def put(self, request: AskPlaces.Request, wake: Callable[[], None] = lambda: None) -> Answer[None]:
        """Tell the keeper; `wake` is called when it has answered."""
        answer: Answer[None] = Answer()
        if not self._looked:
            self._runs.add(request.run)
        self._waiting.put((request, answer, wake))
        return answer

    def free_all(self, run_id: str, machines: Iterable[str]) -> None:
        """A run is over: it wants nothing more, nor do goals of its machines."""
        self.put(AskPlaces.Request(run=run_id, hold=False))
        for machine in machines:
            self.put(AskPlaces.Request(machine=machine, hold=False))

    def watch(self, wake: Callable[[], None]) -> None:
        """Call `wake` when somebody gets or frees a place."""
        self._wakes = [*self._wakes, wake]

    def unwatch(self, wake: Callable[[], None]) -> None:
        """Call it no more."""
        self._wakes = [one for one in self._wakes if one != wake]

    def _changed(self) -> None:
        for wake in self._wakes:
            wake()

    def _free_left(self) -> None:
        """Free what runs want that are over: the scheduler was killed before it could tell."""
        self._looked = True
        for run in sorted(filter(self._own, self.site.runs - self._runs - set(self._recorded()))):
            self._app.log.warning("places_freed", run=run)
            self.put(AskPlaces.Request(run=run, hold=False))

    def _send(self) -> None:
        if not self._looked and self.site.names is not None:
            self._free_left()
        while not self._waiting.empty():
            request, answer, wake = self._waiting.get()
            why = self._told(request)
            answer.settle(None) if why is None else answer.fail(why)
            wake()

    def _told(self, request: AskPlaces.Request) -> Reason | None:
        """Why the keeper refuses a request; it is asked until it answers."""
        while not self._app.stopping.is_set():
            try:
                self.site.answered(ask(self._app.ros, AskPlaces, ASK, request, ASK_LIMIT).revision)
                return None
            except RosError as error:
                if error.reason.find(NoPlace) is not None:
                    return error.reason
            self._app.stopping.wait(ASK_AGAIN)
        return None


class RunPlaces:
    """The places of one run, as its nodes ask for them."""

    def __init__(self, requests: PlaceRequests, run_id: str, wake: Callable[[], None]) -> None:
        self._requests, self._run_id, self._wake = requests, run_id, wake
        requests.watch(wake)

    def hold(self, machine: str, place: str) -> Answer[None]:
        return self._ask(machine, place, hold=True)

    def free(self, machine: str, place: str) -> Answer[None]:
        return self._ask(machine, place, hold=False)

    def waits(self, machine: str, place: str) -> Reason | None:
        return self._requests.site.waits(machine, place)

    def close(self, machines: Iterable[str]) -> None:
        """End the access, as the run is over."""
        self._requests.unwatch(self._wake)
        self._requests.free_all(self._run_id, machines)

    def _ask(self, machine: str, place: str, hold: bool) -> Answer[None]:
        request = AskPlaces.Request(machine=machine, run=self._run_id, places=[place], hold=hold)
        return self._requests.put(request, self._wake)
