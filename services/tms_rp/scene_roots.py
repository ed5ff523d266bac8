"""Records that version 6 of the C++ system calls roots of a scene: names of obstacles, and padding around links."""

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass

from tms_machine.reasons import BadRecord
from tms_machine.values import Value
from tms_reason.errors import SubtaskFailed
from tms_reason.reason import Reason
from tms_rp.reasons import NamesUnfit, NoSuchObstacle, PaddingUnfit

NAMES, PADDING = "collision_object_record_names", "link_padding"
MOST_PADDING = 2.0  # m
STEP = 0.05  # m to which it is rounded up, as each new size costs a body for ever


@dataclass(frozen=True)
class SceneRoot:
    """One such record."""

    name: str
    values: Mapping[str, Value]

    @staticmethod
    def holds(values: Mapping[str, Value]) -> bool:
        """Whether a record is one."""
        return NAMES in values or PADDING in values

    def names(self, known: Collection[str]) -> list[str]:
        """The obstacles that it names, all of them among the known records.

        Raises:
            SubtaskFailed: BadRecord.
        """
        told = self.values.get(NAMES, [])
        if not isinstance(told, list):
            raise self._bad(NamesUnfit(NAMES))
        names = [name for name in told if isinstance(name, str)]
        if len(names) < len(told):
            raise self._bad(NamesUnfit(NAMES))
        if missing := [name for name in names if name not in known]:
            raise self._bad(NoSuchObstacle(missing[0]))
        return names

    def padding(self, links: Collection[str]) -> dict[str, float]:
        """By link: m to keep around it.

        Raises:
            SubtaskFailed: BadRecord.
        """
        told = self.values.get(PADDING, {})
        if not isinstance(told, dict):
            raise self._bad(PaddingUnfit("", MOST_PADDING))
        for link, metres in told.items():
            number = isinstance(metres, (int, float)) and not isinstance(metres, bool)
            if link not in links or not number or not 0 <= metres <= MOST_PADDING:
                raise self._bad(PaddingUnfit(link, MOST_PADDING))
        return {link: STEP * math.ceil(metres / STEP - 1e-6) for link, metres in told.items()}

    def _bad(self, problem: Reason) -> SubtaskFailed:
        return SubtaskFailed(BadRecord(self.name, problem))
