"""Words of `tms ground` that tell a place, an area or a design."""

import math
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tms_cli.words import say

if TYPE_CHECKING:
    from tms_soil.surface import Plane, Point, Surface

CORNERS = 3


class Finite(click.FloatRange):
    """A number within bounds; `nan`, which click takes for one, is within none."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """The number."""
        number = super().convert(value, param, ctx)
        if not math.isfinite(number):
            self.fail(say("'{value}' is no finite number", value=value), param, ctx)
        return number


class Polygon(click.ParamType["tuple[Point, ...]"]):
    """Corners of a polygon: `0,0 10,0 10,5`."""

    name = "X,Y X,Y X,Y..."

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> "tuple[Point, ...]":
        """The corners [m]."""
        corners = [tuple(_number(word) for word in corner.split(",")) for corner in str(value).split()]
        found = tuple((one[0], one[1]) for one in corners if len(one) == 2 and None not in one)
        if len(found) != len(corners) or len(found) < CORNERS:
            self.fail(say("'{value}' is not like \"0,0 10,0 10,5\" (metres in `map`)", value=value), param, ctx)
        return tuple((float(x or 0.0), float(y or 0.0)) for x, y in found)


class Slope(click.ParamType[float]):
    """How steep: `1:1.5` is one up in one and a half along."""

    name = "1:N"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """Rise per length."""
        if isinstance(value, float):
            return value
        fits = re.fullmatch(r"1:(\d+(?:\.\d+)?)", str(value))
        if fits is None or float(fits[1]) <= 0:
            self.fail(say("'{value}' is not like 1:1.5", value=value), param, ctx)
        return 1.0 / float(fits[1])


class Level(click.ParamType["Plane"]):
    """A level plane, `1.5`, or one that rises along x and y: `1.5,0.02,0` (at the origin of `map`)."""

    name = "Z[,SX,SY]"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> "Plane":
        """The plane."""
        from tms_soil.surface import Plane

        if isinstance(value, Plane):
            return value
        numbers = [_number(word) for word in str(value).split(",")]
        if len(numbers) not in (1, 3) or None in numbers:
            self.fail(say("'{value}' is not like 1.5 or 1.5,0.02,0", value=value), param, ctx)
        return Plane(*(number or 0.0 for number in numbers))


def design(plane: "Plane | None", pit: "tuple[Point, ...] | None", floor: float | None, rim: float | None, slope: float,
           file: Path | None) -> "Surface | Path | None":  # fmt: skip
    """The design that the options tell; a path is still to be read, None: there is none.

    Raises:
        click.UsageError: several are told, or a pit without floor and rim.
    """
    if sum(one is not None for one in (plane, pit, file)) > 1:
        raise click.UsageError(say("give one of --plane, --pit and --design"))
    if pit is not None:
        from tms_soil.surface import Pit

        if floor is None or rim is None:
            raise click.UsageError(say("a pit needs --floor and --rim in metres"))
        return Pit(pit, floor, slope, rim)
    return plane or file


def _number(word: str) -> float | None:
    try:
        number = float(word)
    except ValueError:
        return None
    return number if math.isfinite(number) else None
