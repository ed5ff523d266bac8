"""`tms:ground`: hears joints and poses of the machines, and keeps the ground and their loads.

The volumes are estimates: they follow from motions and shapes, and no machine weighs its soil.
"""

import threading

from prometheus_client import Counter, Gauge, Histogram

from tms_config.clock import monotonic
from tms_config.models import MachineModel
from tms_ground.designs import surface_of
from tms_ground.heights import HeightsServer
from tms_ground.reasons import GroundNotKept, GroundOther
from tms_ground.settings import needed, soil_of
from tms_ground.snapshots import Snapshots
from tms_ground.telling import Teller
from tms_ground.watching import GroundWatch, touching
from tms_machine.joint_states import JointStates
from tms_machine.places import Places
from tms_runtime import durable
from tms_runtime.app import App
from tms_soil.earth import GAP

PERIOD = 0.04  # s between two looks at what has come: the period of most joint states
WAITING = 10  # joint states of a machine that may wait for a look: on a busy PC one comes late
LATE = 0.25  # s without joint states, after which the way of an accelerated stand-in is unknown
TELLS = 0.2  # s between two messages of a volume
SAVES = 60.0  # s between two files of the ground: after a power cut so much is lost at most

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
    gap = max(GAP, LATE * _speed(app))
    watch = GroundWatch(ground, soil_of(app.site, ground), touches, app.site.state / "ground.npz", gap)
    design = surface_of(app.site, ground)
    keeper = Keeper(app, watch, touches)
    HeightsServer(app, watch, keeper.teller, keeper.lock, design)
    Snapshots(app, watch, keeper.lock)
    app.ready_when(lambda: None)


def _speed(app: App) -> float:
    """How much faster the machines live than we do; stand-ins may."""
    return app.site.file.sim.speed if app.site.file.backend == "sim" else 1.0


class Keeper:
    """Takes what machines tell, tells their loads, and saves the ground now and then."""

    def __init__(self, app: App, watch: GroundWatch, models: dict[str, MachineModel]) -> None:
        self._log, self._watch = app.log, watch
        borders = {name: app.site.border(name) for name in models}
        self._places = Places(app.ros, borders)
        self._driven = {name: model.driven for name, model in models.items()}
        self._joints = {name: JointStates(app.ros, name, borders[name], driven, WAITING)
                        for name, driven in self._driven.items() if borders[name].joint_states}  # fmt: skip
        self.teller = Teller(app, watch, feeling=app.site.file.backend == "sim")
        self._speed = _speed(app)
        self._times: dict[str, float] = {}  # machine -> when it was looked at last [s of the machines]
        self._told = 0.0
        self.lock = threading.Lock()  # between the threads that look, save and answer
        self._go_on()
        ERROR.set_function(self._mass_error)
        app.ros.poll_in_thread(PERIOD, self.look, "ground")
        app.ros.poll_in_thread(SAVES, self.save, "ground_file")
        app.on_stop(self.save)

    def look(self) -> None:
        """Take what has come since the last look."""
        self._places.take()
        for joints in self._joints.values():
            joints.take()
        with self.lock:
            for name in self._driven:
                self._take(name)
            now = monotonic()
            if now - self._told >= TELLS:
                self._told = now
                self.teller.tell()

    def _take(self, name: str) -> None:
        place, joints = self._places.place(name), self._joints.get(name)
        if place is None or (joints is not None and joints.last is None):
            return  # it has not told enough
        now = monotonic() * self._speed
        before = self._times.get(name, now)
        self._times[name] = now
        told = joints.new or [joints.last[1]] if joints is not None and joints.last is not None else [()]
        for number, angles in enumerate(told, 1):  # what has waited was told in between
            begun = monotonic()
            time = before + (now - before) * number / len(told)
            self._watch.take(name, time, dict(zip(self._driven[name], angles, strict=False)), place)
            UPDATE.observe(monotonic() - begun)
            REPORTS.labels(name).inc()
        self.teller.feel(name)

    def _go_on(self) -> None:
        """Begin with the kept ground; one that cannot be read is put aside."""
        file = self._watch.file
        try:
            if self._watch.load():
                self._log.info("ground_goes_on", file=str(file))
            elif file.exists():
                self._log.warning("ground_begins_anew", reason=GroundOther(str(durable.set_aside(file))))
        except (OSError, ValueError) as error:
            why = GroundNotKept(str(durable.set_aside(file)), str(error))
            self._log.warning("ground_begins_anew", reason=why)

    def _mass_error(self) -> float:
        with self.lock:
            return self._watch.mass_error

    def save(self) -> None:
        """Keep the ground on the disk, if it has changed."""
        with self.lock:
            content = self._watch.content()
        if content is None:
            return
        try:
            durable.replace(self._watch.file, content)
        except OSError as error:
            self._watch.changed = True
            self._log.error("ground_not_saved", reason=GroundNotKept(str(self._watch.file), str(error.strerror)))
