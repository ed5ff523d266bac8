"""Let a machine want a shared place no more."""

from __future__ import annotations

from typing import Any, ClassVar

from tms_ts.bt.registry import node
from tms_ts.bt.status import SUCCESS, Status
from tms_ts.nodes.place_leaf import PlaceLeaf
from tms_ts.world import Pending


@node
class FreePlace(PlaceLeaf):
    """Give a shared place back; others get it once the machine is outside and stands.

    place: the release area, by its id
    model_name: the machine, e.g. ic120_1
    """

    __slots__ = ()
    holds: ClassVar[bool] = False

    def ask(self) -> Pending[Any]:
        return self.world.places.free(self.model_name, self.place)

    def answered(self, value: Any) -> Status:
        return SUCCESS
