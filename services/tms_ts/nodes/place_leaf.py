"""The base of leaves that take or free a shared place for a machine."""

from __future__ import annotations

from typing import ClassVar

from tms_reason.reason import Reason
from tms_ts.bt.node import AtOnce
from tms_ts.bt.ports import In
from tms_ts.nodes.asking import Asking
from tms_ts.tree_reasons import NameMissing


class PlaceLeaf(Asking):
    """Names a machine and a place."""

    __slots__ = ()
    holds: ClassVar[bool]
    required = frozenset({"place", "model_name"})
    place: In[str]
    model_name: In[str]

    def place_asked(self) -> tuple[str, str]:
        """Machine and place; a part that is known only during the run is its {key}."""
        return self.reported("model_name"), self.reported("place")

    def faults(self) -> list[Reason]:
        return [
            NameMissing(self.registration_name, port) for port in ("place", "model_name") if self.literal(port) == ""
        ]

    def synchronous_outcomes(self, children: list[AtOnce]) -> AtOnce:
        return False, False
