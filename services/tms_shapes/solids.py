"""The solids of a machine."""

from collections.abc import Iterator

from tms_config.models import Box, MachineModel, Solid
from tms_control.links import turned


def solids(model: MachineModel) -> tuple[Solid, ...]:
    """As its file tells them; boxes around its bodies, or around its footprint, where it tells none."""
    if model.solids:
        return model.solids
    return tuple(_boxes(model))


def _boxes(model: MachineModel) -> Iterator[Solid]:
    boxes = list(model.shapes.items()) or [("base_link", box) for box in model.footprint.values()]
    for link, box in boxes:
        yield Solid(link=link, role="body", y=((box.min[1], box.max[1]),), outline=tuple(_corners(box)))


def _corners(box: Box) -> Iterator[tuple[float, float]]:
    """X and z of a box on its link, which turns it about y."""
    turn = turned("y", box.pitch)
    (x0, _, z0), (x1, _, z1) = box.min, box.max
    for corner in ((x0, 0.0, z0), (x1, 0.0, z0), (x1, 0.0, z1), (x0, 0.0, z1)):
        x, _, z = (turn @ corner).tolist()
        yield x, z
