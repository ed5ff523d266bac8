"""A machine as a ROS 2 package: its URDF moves as the machine's file says, its meshes are the solids of the file."""

import io
import math
import zipfile

import numpy as np
import pytest
import trimesh
from lxml import etree
from shapely.geometry import Polygon

from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_control.links import Links
from tms_shapes.package import package
from tms_shapes.solids import solids
from tms_shapes.urdf import groups

MODELS = {path.stem: parse(path, MachineModel) for path in sorted((CONFIGS / "machines").glob("*.yaml"))}


def unpacked(name: str, backend: str = "sim") -> tuple[dict[str, bytes], etree._Element]:
    """The files of a package by their paths below its folder, and the root of the URDF."""
    model = MODELS[name]
    with zipfile.ZipFile(io.BytesIO(package(name, model, model.borders[backend]))) as found:  # type: ignore[index]
        folder = f"{name}_description/"
        files = {path.removeprefix(folder): found.read(path) for path in found.namelist()}
    return files, etree.fromstring(files[f"urdf/{name}.urdf"])


def numbers(element: etree._Element, name: str) -> np.ndarray:
    return np.array([float(one) for one in element.get(name, "").split()])


def turned(axis: np.ndarray, angle: float) -> np.ndarray:
    """About an axis (Rodrigues)."""
    x, y, z = axis
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * k + (1 - math.cos(angle)) * k @ k


def places(robot: etree._Element, angles: dict[str, float]) -> dict[str, np.ndarray]:
    """The place of every link (4 x 4) by the rules of URDF: roll, pitch, yaw about fixed axes, then the joint."""
    found = {"base_link": np.eye(4)}
    for joint in robot.iterfind("joint"):
        origin, axis = joint.find("origin"), joint.find("axis")
        roll, pitch, yaw = numbers(origin, "rpy")
        x, y, z = np.eye(3)
        fixed = turned(z, yaw) @ turned(y, pitch) @ turned(x, roll)
        moved = np.eye(3) if axis is None else turned(numbers(axis, "xyz"), angles[joint.get("name", "")])
        step = np.eye(4)
        step[:3, :3], step[:3, 3] = fixed @ moved, numbers(origin, "xyz")
        found[joint.find("child").get("link")] = found[joint.find("parent").get("link")] @ step
    return found


@pytest.mark.parametrize("name", MODELS)
def test_the_links_of_the_urdf_are_where_the_machines_file_has_them(name: str) -> None:
    model, (_, robot) = MODELS[name], unpacked(name)
    pose = np.random.default_rng(7).uniform(-1.0, 1.0, (1, len(model.joints)))
    names = model.borders["sim"].joints
    angles = {names.get(joint, joint): angle for joint, angle in zip(model.joints, pose[0], strict=True)}
    links = [one.child for one in model.geometry.values()]
    found, wanted = places(robot, angles), Links(model, links).places(pose)
    for link in links:
        assert found[link] == pytest.approx(wanted[link][0], abs=1e-5), link


def test_joints_have_the_limits_of_the_file() -> None:
    robot = unpacked("zx200")[1]
    boom = robot.find("joint[@name='boom_joint']")
    bounds = MODELS["zx200"].joints["boom_joint"]
    assert boom.get("type") == "revolute"
    assert {name: float(boom.find("limit").get(name)) for name in ("lower", "upper", "velocity")} == {
        "lower": bounds.min, "upper": bounds.max, "velocity": bounds.velocity,
    }  # fmt: skip
    kinds = {joint.get("name"): joint.get("type") for joint in robot.iterfind("joint")}
    assert kinds["base_joint"] == "fixed" and kinds["swing_joint"] == "continuous"


def test_joints_are_named_as_at_the_border() -> None:
    renamed = [
        (name, backend, set(border.joints.values()))
        for name, model in MODELS.items()
        for backend, border in model.borders.items()
        if border.joints
    ]
    assert renamed
    for name, backend, names in renamed:
        assert names <= {joint.get("name") for joint in unpacked(name, backend)[1].iterfind("joint")}


@pytest.mark.parametrize("name", MODELS)
def test_every_mesh_has_the_size_of_its_solids(name: str) -> None:
    files, robot = unpacked(name)
    named = {mesh.get("filename") for mesh in robot.iterfind(".//mesh")}
    assert named == {f"package://{name}_description/{path}" for path in files if path.endswith(".stl")}
    for (link, role), parts in groups(solids(MODELS[name])).items():
        mesh = trimesh.load_mesh(io.BytesIO(files[f"meshes/{link}_{role}.stl"]), file_type="stl")
        volume = sum(Polygon(one.outline).area * (high - low) for one in parts for low, high in one.y)
        assert mesh.volume == pytest.approx(volume, rel=1e-4), (link, role)  # of closed prisms
        x, z = zip(*(at for one in parts for at in one.outline), strict=True)
        y = [at for one in parts for span in one.y for at in span]
        wanted = [[min(x), min(y), min(z)], [max(x), max(y), max(z)]]
        assert np.array(mesh.bounds) == pytest.approx(np.array(wanted), abs=1e-5)


def test_bodies_to_collide_are_the_boxes_of_the_file() -> None:
    robot = unpacked("zx200")[1]
    box = MODELS["zx200"].shapes["boom_link"]
    found = robot.find("link[@name='boom_link']/collision")
    size = numbers(found.find("geometry/box"), "size")
    assert size == pytest.approx([high - low for low, high in zip(box.min, box.max, strict=True)])
    origin = found.find("origin")
    middle = turned(np.array([0, 1, 0]), box.pitch) @ (np.array(box.min) + box.max) / 2
    assert numbers(origin, "xyz") == pytest.approx(middle, abs=1e-4)
    assert numbers(origin, "rpy") == pytest.approx([0.0, box.pitch, 0.0])


def test_a_machine_without_solids_is_boxes_and_the_same_machine_the_same_file() -> None:
    bare = MODELS["zx200"].model_copy(update={"solids": ()})
    assert [one.link for one in solids(bare)] == list(bare.shapes)
    corners = np.array(solids(bare)[2].outline)  # the boom's, turned by its pitch
    x, z = (bare.shapes["boom_link"].max[i] - bare.shapes["boom_link"].min[i] for i in (0, 2))
    assert Polygon(corners).area == pytest.approx(x * z)
    ahead = turned(np.array([0, 1, 0]), bare.shapes["boom_link"].pitch) @ (1, 0, 0)
    assert (corners[1] - corners[0]) / x == pytest.approx([ahead[0], ahead[2]])
    none = bare.model_copy(update={"shapes": {}})
    assert [one.link for one in solids(none)] == ["base_link"] * len(bare.footprint)
    assert package("zx200", bare, bare.borders["sim"]) == package("zx200", bare, bare.borders["sim"])
