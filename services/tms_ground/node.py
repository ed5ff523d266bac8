"""`tms:ground`: hears joints and poses of the machines, and keeps the ground and their loads.

The volumes are estimates: they follow from motions and shapes, and no machine weighs its soil.
"""

import threading

from prometheus_client import Counter, Gauge, Histogram

from tms_config.clock import monotonic, unix_time
from tms_config.config import Site
from tms_config.models import MachineModel
from tms_ground.counting import begin, counted
from tms_ground.delivery import Delivery
from tms_ground.designs import surface_of
from tms_ground.duties import Duties
from tms_ground.going_on import go_on
from tms_ground.heights import HeightsServer
from tms_ground.reasons import GroundNotKept
from tms_ground.seen import Seen
from tms_ground.settings import needed, soils_of
from tms_ground.snapshots import Snapshots
from tms_ground.telling import Teller
from tms_ground.watching import GroundWatch, touching
from tms_machine.listener import Listener
from tms_runtime import durable
from tms_runtime.app import App

PERIOD = 0.04  # s between two looks at what has come: the period of most joint states
WAITING = 250  # joint states of a machine that may wait, 10 s: if one is lost, what its bucket did then is lost
TELLS = 0.2  # s of the machines between two messages of a volume: who waits for one loses little time at any speed
SAVES = 60.0  # s of the machines between two files of the ground: after a power cut so much is lost at most
EARLY = 0.01  # s; looks are so far apart only nearly
CYCLES = 2.0  # s between two looks for full buckets and finished cycles, with which the ground is saved at once

REPORTS = Counter("tms_ground_reports_total", "Reports of machines that were taken", ["machine"])
UPDATE = Histogram("tms_ground_update_seconds", "Time of one report", buckets=(0.0003, 0.001, 0.003, 0.01, 0.03, 0.1))
ERROR = Gauge("tms_ground_mass_error_kilograms", "Mass made or lost since the start; not 0 is a fault")


def start(app: App) -> None:
    """Keep the ground of the site.

    Raises:
        ConfigError: `ground:` of the site file or configs/soils.yaml is wrong.
    """
    ground = needed(app.site)
    models = {name: app.site.model_of(name) for name in app.site.file.machines}
    touches = touching(models)
    for name in models.keys() - touches.keys():
        app.log.warning("leaves_ground", target=name)
    watch = GroundWatch(ground, soils_of(app.site, ground), touches, app.site.state / "ground.npz", speed_of(app.site))
    design = surface_of(app.site, ground)
    keeper = Keeper(app, watch, touches)
    HeightsServer(app, watch, keeper.teller, keeper.lock, design)
    Snapshots(app, watch, keeper.lock)
    Seen(app, watch, keeper.lock)
    app.ready_when(lambda: None)


def speed_of(site: Site) -> float:
    """Seconds of the machines in one of ours: stand-ins may live faster than we do."""
    return site.file.sim.speed if site.file.backend == "sim" else 1.0


class Keeper:
    """Takes what machines tell, tells their loads and cycles, and saves the ground now and then."""

    def __init__(self, app: App, watch: GroundWatch, models: dict[str, MachineModel]) -> None:
        self._log, self._ros, self._watch = app.log, app.ros, watch
        self._machines = list(models)
        self._listener = Listener(app.ros, app.site, models, models, WAITING)
        self.teller = Teller(app, watch, feeling=app.site.file.backend == "sim")
        self._speed = speed_of(app.site)
        self._times: dict[str, float] = {}  # machine -> when it was looked at last [s of the machines]
        begin(watch.work.kinds)
        self._duties = Duties(app.ros, app.site, models)
        self._delivery = Delivery(app.ros, app.log, watch.waiting)
        self._told = 0.0
        self.lock = threading.Lock()  # between the threads that look, save and answer
        self._saving = threading.Lock()  # of those that save
        self._missed = go_on(watch, app.log, unix_time())
        ERROR.set_function(self._mass_error)
        app.ros.poll_in_thread(PERIOD, self.look, "ground")
        app.ros.poll_in_thread(SAVES / max(1.0, self._speed), self.save, "ground_file")
        app.ros.poll_in_thread(CYCLES, self.deliver, "cycles")
        app.on_stop(self.save)

    def look(self) -> None:
        """Take what has come since the last look."""
        stamp = self._ros.now()
        self._listener.take()
        for name in self._machines:
            self._take(name)
        now = monotonic()
        if now - self._told >= TELLS / self._speed - EARLY:
            self._told = now
            with self.lock:
                self.teller.tell(stamp)

    def _take(self, name: str) -> None:
        place, joints = self._listener.places.place(name), self._listener.joints(name)
        if place is None or (joints is None and self._listener.has_joints(name)):
            return  # it has not told enough
        now, angles = monotonic() * self._speed, {} if joints is None else joints.angles
        if (seen := self._missed.pop(name, None)) is not None:
            with self.lock:
                self._watch.miss(name, (unix_time() - seen) * self._speed, angles, place)
        before = self._times.get(name, now)
        self._times[name] = now
        told = self._listener.new_joints(name) or [angles]
        for number, one in enumerate(told, 1):  # what has waited was told in between
            with self.lock:  # for one at a time: who asks for heights comes in between
                begun = monotonic()
                self._watch.take(name, before + (now - before) * number / len(told), one, place)
                UPDATE.observe(monotonic() - begun)
                late = (now - before) * (1 - number / len(told)) / self._speed
                counted(self._watch.count(name, unix_time() - late, one, place, self._duties.of(name)))
            REPORTS.labels(name).inc()
        with self.lock:
            self.teller.feel(name)

    def _mass_error(self) -> float:
        with self.lock:
            return self._watch.mass_error

    def deliver(self) -> None:
        """Keep full buckets, and finished cycles; send these once they are on the disk."""
        if self._watch.waiting.unkept or self._watch.work.filled:
            self.save()
        self._delivery.send()

    def save(self) -> None:
        """Keep ground and work on the disk, if they have changed."""
        with self._saving:
            watch, file = self._watch, str(self._watch.file)
            with self.lock:
                trouble, content = watch.journal.trouble, watch.content()
                made, journal = watch.waiting.made, watch.journal.number
            if trouble is not None:
                self._log.error("journal_not_kept", reason=GroundNotKept(file, str(trouble.strerror)))
            if content is None:
                return
            try:
                durable.replace(watch.file, content.ground)
                durable.replace(watch.copy, content.work)
                watch.waiting.kept(made)
                watch.journal.drop(journal)
            except OSError as error:
                watch.changed = True
                self._log.error("ground_not_saved", reason=GroundNotKept(file, str(error.strerror)))
