"""Units of a reason's arguments: the number of shown digits, and the symbol after them."""

from dataclasses import dataclass
from typing import Annotated


@dataclass(frozen=True)
class Unit:
    """A physical unit, as its symbol, with the digits behind the point that are shown."""

    symbol: str
    digits: int

    def show(self, value: float) -> str:
        """`0.35 s`; a unit without a symbol shows the number alone."""
        return f"{value:.{self.digits}f} {self.symbol}".rstrip()


Seconds = Annotated[float, Unit("s", 1)]
Moments = Annotated[float, Unit("s", 2)]  # times of stops and stand-still, where hundredths matter
Metres = Annotated[float, Unit("m", 2)]
SquareMetres = Annotated[float, Unit("m²", 1)]
MetresPerSecond = Annotated[float, Unit("m/s", 3)]
Radians = Annotated[float, Unit("rad", 3)]
RadiansPerSecond = Annotated[float, Unit("rad/s", 3)]
Degrees = Annotated[float, Unit("deg", 1)]
Hertz = Annotated[float, Unit("Hz", 1)]
Percent = Annotated[float, Unit("%", 0)]
Megabytes = Annotated[float, Unit("MB", 1)]
CubicMetres = Annotated[float, Unit("m³", 2)]
Number = Annotated[float, Unit("", 3)]
