"""What stands and lies around a machine: the other machines, their loads, and the ground of the site."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np
from tms_msg_ground.msg import SoilLoad
from tms_msg_ground.srv import GetHeights

from tms_config.clock import monotonic, sleep, unix_time
from tms_config.config import Site
from tms_config.models import MachineModel
from tms_control.ground import Outline
from tms_control.links import Links, Matrix, placed
from tms_kit.reasons import LoadNotTold, PlaceNotTold
from tms_kit.site_places import SitePlaces
from tms_machine.frames import FramePose
from tms_machine.places import Places
from tms_machine.reasons import WaitingFor
from tms_machine.stamps import seconds
from tms_reason.errors import SubtaskFailed
from tms_reason.wire import refusal
from tms_ros.node import Ros
from tms_soil.patches import heights
from tms_soil.surface import Bounds, Heights, Point

HEARS = 3.0  # s to hear where a machine is or what it carries: both are told several times a second
LOOKS = 0.05  # s between two looks
GROUND, HEIGHTS = "tms:ground", "/tms/ground/get_heights"
COMES_BACK = 20.0  # s for tms:ground, which may be restarting


class Yard:
    """As one machine sees it; `check` of the machine ends every wait."""

    def __init__(self, ros: Ros, site: Site) -> None:
        self._ros, self._site = ros, site
        machines = site.file.machines
        self._places = Places(ros, {name: site.border(name) for name in machines})
        models = {name: site.model_of(name) for name in machines}
        self._loads = {
            name: ros.sample(SoilLoad, f"/{name}/soil_load")
            for name, model in models.items()
            if model.bucket or model.vessel
        }

    @cached_property
    def shared(self) -> SitePlaces:
        """The shared places of the site."""
        return SitePlaces(self._ros)

    def model(self, machine: str) -> MachineModel:
        """The model of a machine of the site; ConfigError where there is none."""
        return self._site.model_of(machine)

    def place(self, machine: str, check: Callable[[], None]) -> FramePose:
        """Where a machine stands.

        Raises:
            SubtaskFailed: PlaceNotTold.
        """
        until = monotonic() + HEARS
        while True:
            self._places.take()
            if (found := self._places.place(machine)) is not None:
                return found
            check()
            if monotonic() > until:
                raise SubtaskFailed(PlaceNotTold(machine))
            sleep(LOOKS)

    def taken(self, own: str) -> list[Sequence[Point]]:
        """What the other machines stand on: around their footprints, in map. One that tells no place is left out."""
        self._places.take()
        found: list[Sequence[Point]] = []
        for name in self._site.file.machines:
            if name != own and (place := self._places.place(name)) is not None:
                base = placed(*place[:3])
                corners = (base @ (x, y, 0.0, 1.0) for x, y in Outline.of(self.model(name)).polygon)
                found.append([(float(at[0]), float(at[1])) for at in corners])
        return found

    def link(self, machine: str, link: str, check: Callable[[], None]) -> Matrix:
        """A link of a machine in map, with its joints at 0: a vessel that is down.

        Raises:
            SubtaskFailed: PlaceNotTold.
        """
        model = self.model(machine)
        at: Matrix = (
            placed(*self.place(machine, check)[:3])
            @ Links(model, [link]).places(np.zeros((1, len(model.joints))))[link][0]
        )
        return at

    def loads(self, machines: Sequence[str], check: Callable[[], None]) -> list[SoilLoad]:
        """What machines carry now: a ground that has taken all that they had told before this call tells it.

        On a busy PC `tms:ground` is late, and what it tells still leaves the last bucket out. Clocks of PCs agree.

        Raises:
            SubtaskFailed: LoadNotTold.
        """
        found: dict[str, SoilLoad] = {}
        for name in machines:
            self._new_loads(name)  # what has waited is old
        begun, until = unix_time(), monotonic() + COMES_BACK
        while missing := [name for name in machines if name not in found]:
            for name in missing:
                if (told := self._new_loads(name)) and seconds(told[-1].stamp) >= begun:
                    found[name] = told[-1]
            check()
            if monotonic() > until:
                raise SubtaskFailed(LoadNotTold(missing[0]))
            sleep(LOOKS)
        return [found[name] for name in machines]

    def _new_loads(self, machine: str) -> list[SoilLoad]:
        take = self._loads.get(machine)
        return [] if take is None else take()

    def ground(self, bounds: Bounds, floor: float, check: Callable[[], None]) -> tuple[Heights, Heights]:
        """The ground, and what it should become: the site's design, nowhere below `floor` [m]; both on the same cells.

        Raises:
            SubtaskFailed: WaitingFor tms:ground, or what it says.
        """
        until = monotonic() + COMES_BACK
        while not self._ros.has_service(GetHeights, HEIGHTS):
            check()
            if monotonic() > until:
                raise SubtaskFailed(WaitingFor(GROUND))
            sleep(LOOKS)
        x0, y0, x1, y1 = bounds
        request = GetHeights.Request(x0=x0, y0=y0, x1=x1, y1=y1)
        answer = self._ros.call(GetHeights, HEIGHTS, request, COMES_BACK)
        if answer.error_code:
            raise SubtaskFailed(refusal(answer.error_code, answer.error_msg))
        now = heights(answer.ground)
        # Without a design, the floor is it; with one, nothing is dug where that says nothing.
        known = len(answer.design) > 0
        wanted = np.array(answer.design, dtype=np.float64).reshape(now.z.shape) if known else np.full_like(now.z, floor)
        return now, replace(now, z=np.maximum(wanted, floor))
