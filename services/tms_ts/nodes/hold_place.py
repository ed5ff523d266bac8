"""Let a machine hold a shared place."""

from __future__ import annotations

from typing import Any, ClassVar

from tms_ts.bt.registry import node
from tms_ts.bt.status import RUNNING, SUCCESS, Status
from tms_ts.nodes.place_leaf import PlaceLeaf
from tms_ts.world import Pending


@node
class HoldPlace(PlaceLeaf):
    """Wait until a machine alone holds a shared place (a release area), in the order of arrival; then succeed.

    It holds the place until FreePlace, or the end of the run; even then while it stands inside.

    place: the release area, by its id
    model_name: the machine, e.g. ic120_1
    """

    __slots__ = ("taken",)
    holds: ClassVar[bool] = True

    def prepare(self) -> None:
        super().prepare()
        self.taken: tuple[str, str] | None = None  # machine and place, from the answer of the keeper on

    def ask(self) -> Pending[Any]:
        return self.world.places.hold(self.model_name, self.place)

    def answered(self, value: Any) -> Status:
        self.taken = (self.model_name, self.place)
        return self.tick()

    def tick(self) -> Status:
        if self.taken is None:
            return super().tick()
        self.reason = self.world.places.waits(*self.taken)
        if self.reason is not None:
            return RUNNING
        self.taken = None
        return SUCCESS

    def halt(self) -> None:
        """Wait no more. What is not held yet is not wanted any more."""
        if self.pending is not None or self.taken is not None:
            self.world.places.free(self.model_name, self.place)
        self.taken = None
        super().halt()
