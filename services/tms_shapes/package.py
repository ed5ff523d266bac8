"""A machine as a ROS 2 package in a zip file: its URDF and meshes, for RViz, Foxglove and MoveIt."""

import io
import zipfile

from lxml import etree
from lxml.builder import E

from tms_config.models import Border, MachineModel
from tms_shapes import urdf
from tms_shapes.meshes import stl
from tms_shapes.solids import solids

LICENCE = "Apache-2.0"
MAINTAINER = "ROS2-TMS for Construction, task management"
CMAKE = """cmake_minimum_required(VERSION 3.8)
project({package})
find_package(ament_cmake REQUIRED)
install(DIRECTORY meshes urdf DESTINATION share/${{PROJECT_NAME}})
ament_package()
"""
STAMP = (1980, 1, 1, 0, 0, 0)  # the same input gives the same file


def package(name: str, model: MachineModel, border: Border) -> bytes:
    """The zip file of a machine; its joints are named as at its border."""
    parts = urdf.groups(solids(model))
    folder = f"{name}_description"
    files = {f"meshes/{link}_{role}.stl": stl(some) for (link, role), some in parts.items()}
    meshes = {(link, role): f"package://{folder}/meshes/{link}_{role}.stl" for link, role in parts}
    files |= {
        f"urdf/{name}.urdf": urdf.robot(name, model, border.joints, meshes),
        "package.xml": _package_xml(folder, name),
        "CMakeLists.txt": CMAKE.format(package=folder).encode(),
    }
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as found:
        for path, data in files.items():
            entry = zipfile.ZipInfo(f"{folder}/{path}", STAMP)
            entry.compress_type = zipfile.ZIP_DEFLATED
            found.writestr(entry, data)
    return out.getvalue()


def _package_xml(folder: str, machine: str) -> bytes:
    found = E.package(
        E.name(folder), E.version("0.1.0"), E.description(f"{machine} as low-poly shapes, with its joints"),
        E.maintainer(MAINTAINER, email="nobody@example.org"), E.license(LICENCE),
        E.buildtool_depend("ament_cmake"), E.export(E.build_type("ament_cmake")),
        format="3",
    )  # fmt: skip
    data: bytes = etree.tostring(found, encoding="utf-8", xml_declaration=True, pretty_print=True)
    return data
