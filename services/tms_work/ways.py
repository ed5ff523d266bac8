"""The kinds of cycles that are recognised: what their parts are called, and where they differ."""

from dataclasses import dataclass

from tms_work.cycle import Kind


@dataclass(frozen=True)
class Way:
    """The names of the parts, in their order; a cycle ends when the load is out."""

    kind: Kind
    empty: str  # back to where it fills
    fill: str
    carry: str
    pour: str
    wait: str
    waits: frozenset[str]  # parts in which standing still is waiting
    falls_back: bool  # what falls out while it fills has not gone anywhere, but for a carrier below


EXCAVATOR = Way(
    kind="dig", empty="swing_back", fill="dig", carry="swing_loaded", pour="dump", wait="wait_for_truck",
    waits=frozenset({"swing_back", "dig", "swing_loaded", "dump"}), falls_back=True,
)  # fmt: skip
# A carrier stands while it is loaded and while it tips.
CARRIER = Way(
    kind="haul", empty="return", fill="load", carry="haul", pour="tip", wait="wait",
    waits=frozenset({"return", "haul"}), falls_back=False,
)  # fmt: skip
