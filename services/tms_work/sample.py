"""What is known of a machine at one time, as far as cycles follow from it."""

from typing import NamedTuple


class Amount(NamedTuple):
    """Some soil."""

    mass: float = 0.0  # kg
    bank: float = 0.0  # m3, as it lay
    loose: float = 0.0  # m3, as it is carried

    def more(self, other: "Amount") -> "Amount":
        """Both amounts together."""
        return Amount(self.mass + other.mass, self.bank + other.bank, self.loose + other.loose)

    def less(self, other: "Amount") -> "Amount":
        """The difference to a smaller amount."""
        return Amount(self.mass - other.mass, self.bank - other.bank, self.loose - other.loose)


class Sample(NamedTuple):
    """A machine at one time."""

    time: float  # s since 1970
    load: Amount  # in its bucket or vessel
    run: str = ""  # that holds it; empty: none
    soil: str = ""  # kind of most of the load
    x: float = 0.0  # m, base_link in map
    y: float = 0.0  # m
    moves: bool = False  # a joint or a track
    stopped: bool = False  # latched, held, or being stopped
    measured: bool = False  # the load, by the machine; otherwise it is an estimate
    swing: float = 0.0  # rad/s, of an excavator's upper body, either way
    cuts: bool = False  # the edge of an excavator's bucket is in the ground
    estimated: bool = False  # the load follows from how machines stood before and after a silence
    under: str = ""  # carrier below an excavator's bucket; empty: none
