"""A machine as URDF: its links, its joints with the limits of its file, its solids to look at, its bodies to collide.

Form: the specification of ROS's urdf package. A joint that the file gives no limits turns for ever, one that nothing
moves is fixed. Nobody has told the torques of the joints: `effort`, which the form demands, is 0.
"""

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from lxml import etree
from lxml.builder import E

from tms_config.models import Box, Joint, MachineModel, Origin, Solid
from tms_control.links import turned

COLOURS: dict[str, str] = {  # red, green, blue, opacity, as in the console
    "track": "0.23 0.25 0.29 1", "body": "1 0.69 0 1", "arm": "1 0.79 0.3 1", "tool": "0.48 0.33 0.09 1",
}  # fmt: skip
Meshes = Mapping[tuple[str, str], str]  # link and role of solids -> address of the mesh of them


def robot(name: str, model: MachineModel, names: Mapping[str, str], meshes: Meshes) -> bytes:
    """The URDF of a machine; `names`: joint of the model -> its name in /joint_states, where they differ."""
    links = ["base_link", *(one.child for one in model.geometry.values())]
    found = E.robot(
        *(E.material(E.color(rgba=colour), name=role) for role, colour in COLOURS.items()),
        *(_link(link, model.shapes.get(link), meshes) for link in links),
        *(_joint(names.get(joint, joint), at, model.joints.get(joint)) for joint, at in model.geometry.items()),
        name=name,
    )
    data: bytes = etree.tostring(found, encoding="utf-8", xml_declaration=True, pretty_print=True)
    return data


def groups(solids: tuple[Solid, ...]) -> dict[tuple[str, str], list[Solid]]:
    """Solids by link and role: those of one mesh."""
    found: dict[tuple[str, str], list[Solid]] = {}
    for one in solids:
        found.setdefault((one.link, one.role), []).append(one)
    return found


def _link(link: str, body: Box | None, meshes: Meshes) -> Any:
    looks = [
        E.visual(E.geometry(E.mesh(filename=file)), E.material(name=role))
        for (of, role), file in meshes.items()
        if of == link
    ]
    return E.link(*looks, *([] if body is None else [_collision(body)]), name=link)


def _collision(box: Box) -> Any:
    """A box of its link, which is turned about y."""
    middle = turned("y", box.pitch) @ (np.add(box.min, box.max) / 2)
    size = np.subtract(box.max, box.min)
    return E.collision(_origin(middle, box.pitch), E.geometry(E.box(size=_row(size))))


def _joint(name: str, at: Origin, limits: Joint | None) -> Any:
    axis = {"x": "1 0 0", "y": "0 1 0", "z": "0 0 1"}[at.axis]
    parts = [_origin(at.xyz, at.pitch), E.parent(link=at.parent), E.child(link=at.child)]
    if limits is None:
        return E.joint(*parts, name=name, type="fixed")
    parts.append(E.axis(xyz=axis))
    bounds = {"velocity": str(limits.velocity), "effort": "0"}
    if limits.min is None or limits.max is None:
        return E.joint(*parts, E.limit(**bounds), name=name, type="continuous")
    bounds |= {"lower": str(limits.min), "upper": str(limits.max)}
    return E.joint(*parts, E.limit(**bounds), name=name, type="revolute")


def _origin(xyz: Iterable[float], pitch: float) -> Any:
    return E.origin(xyz=_row(xyz), rpy=_row((0.0, pitch, 0.0)))


def _row(numbers: Iterable[float]) -> str:
    return " ".join(f"{one:.10g}" for one in numbers)
