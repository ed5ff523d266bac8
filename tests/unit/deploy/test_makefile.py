"""What `make` would do, as `make -n` tells it; nothing is run."""

import os
import subprocess
from pathlib import Path

import pytest

from conftest import PROJECT
from tms_config.site_file import ROLES

HIDDEN = {
    "SITE", "ROLE", "PC", "RUNTIME", "VENV", "NAV2_DISTRO", "LOCK", "PYTHON", "TMS_SITE", "TMS_IMAGE", "MAKEFLAGS",
}  # fmt: skip


def make(*argv: str) -> str:
    clean = {key: value for key, value in os.environ.items() if key not in HIDDEN}
    argv = ("make", "-n", *argv, "DOCKER=docker", "COMPOSE=docker-compose")
    done = subprocess.run(argv, cwd=PROJECT, env=clean, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.fixture
def built(tmp_path: Path) -> str:
    """An environment that was set up after `make interfaces NAV2_DISTRO=humble`."""
    venv = tmp_path / "venv"
    for file in ("bin/uv", ".requirements", "interfaces/.humble", ".interfaces-humble", ".ready"):
        (venv / file).parent.mkdir(parents=True, exist_ok=True)
        (venv / file).touch()
    for other in (tmp_path / "venv-store", tmp_path / "venv-console"):
        other.mkdir()
        (other / ".ready").touch()
    return f"VENV={venv}"


def test_the_next_make_keeps_the_interfaces_that_were_built_for_humble(built: str) -> None:
    assert "building the ROS interface packages" not in make("status", built)
    assert "pip install" not in make("status", built)


def test_who_asks_for_the_other_ones_gets_them(built: str) -> None:
    reported = make("interfaces", built, "NAV2_DISTRO=jazzy")
    assert "building the ROS interface packages" in reported
    venv = built.removeprefix("VENV=")
    assert reported.index(f"rm -f {venv}/.interfaces-*") < reported.index(f"touch {venv}/.interfaces-jazzy")


def test_without_any_they_are_those_of_jazzy(tmp_path: Path) -> None:
    assert f"touch {tmp_path}/.interfaces-jazzy" in make("interfaces", f"VENV={tmp_path}")


@pytest.mark.parametrize("whole", [True, False])
def test_the_distributions_python_is_taken_where_it_is_whole(tmp_path: Path, whole: bool) -> None:
    program = tmp_path / "distribution"
    program.write_text(f"#!/bin/sh\nexit {int(not whole)}\n")
    program.chmod(0o755)
    commands = make("setup", f"VENV={tmp_path}/venv", f"DISTRIBUTION={program}").splitlines()
    expected = str(program) if whole else "python3"
    assert f"{expected} -m venv {tmp_path}/venv" in commands
    assert [line for line in commands if line.startswith(f"PYTHON={expected} sh deploy/system-packages.sh")]
    assert f"python3.13 -m venv {tmp_path}/venv" in make("setup", f"VENV={tmp_path}/venv", "PYTHON=python3.13")


@pytest.mark.parametrize(
    ("argv", "state"), [((), "demo"), (("SITE=genba",), "genba"), (("SITE=configs/sites/genba.yaml",), "genba")]
)
def test_clean_leaves_the_state_of_other_sites(tmp_path: Path, argv: tuple[str, ...], state: str) -> None:
    """Latches and the numbers of runs are there."""
    (removal,) = [line for line in make("clean", f"VENV={tmp_path}", *argv).splitlines() if line.startswith("rm ")]
    made = f"{tmp_path} {tmp_path}-store {tmp_path}-console node_modules services/tms_ur/built/"
    assert removal == f"rm -rf {made} .state/{state}"


@pytest.mark.parametrize("role", ROLES)
def test_a_pc_in_containers_is_named_after_its_role(role: str) -> None:
    reported = make("up", "SITE=genba", f"ROLE={role}", "RUNTIME=docker")
    assert f"TMS_SITE_NAME=genba TMS_PC={role} docker-compose -p tms-{role} -f deploy/compose/{role}.yml up" in reported


def test_a_pc_with_a_name_of_its_own_takes_its_roles_compose_file() -> None:
    argv = ("SITE=genba", "ROLE=machine", "PC=truck_pc", "RUNTIME=docker")
    wanted = "TMS_SITE_NAME=genba TMS_PC=truck_pc docker-compose -p tms-truck_pc -f deploy/compose/machine.yml"
    assert f"{wanted} up" in make("up", *argv) and f"{wanted} down" in make("down", *argv)


@pytest.mark.parametrize("argv", [("ROLE=truck_pc",), ("ROLE=machine", "PC=truck_pc")])
def test_without_containers_either_way_names_the_pc(built: str, argv: tuple[str, ...]) -> None:
    assert "--site genba up --role truck_pc" in make("up", built, "SITE=genba", *argv)


@pytest.mark.parametrize("runtime", ["native", "docker"])
def test_sockets_have_their_room_before_a_mesh_starts(runtime: str, built: str) -> None:
    commands = make("up", "SITE=yard", "ROLE=cps", f"RUNTIME={runtime}", "TMS_IMAGE=ros2-tms", built).splitlines()
    (start,) = [at for at, line in enumerate(commands) if " up --" in line]
    assert "sh deploy/sockets.sh" in commands[:start]
