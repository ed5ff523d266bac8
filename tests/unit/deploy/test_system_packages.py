"""What `deploy/system-packages.sh` installs on a bare PC; apt-get and who is there are made up."""

import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from conftest import PROJECT

SCRIPT = PROJECT / "deploy" / "system-packages.sh"
Install = Callable[..., tuple[subprocess.CompletedProcess[str], str]]


def program(path: Path, text: str) -> None:
    path.write_text(f"#!/bin/sh\n{text}\n")
    path.chmod(0o755)


@pytest.fixture
def install(tmp_path: Path) -> Install:
    """Run the script where only these programs are; what it told, and what it asked of apt-get."""
    folder, asked = tmp_path / "bin", tmp_path / "asked"
    folder.mkdir()
    asked.write_text("")

    def run(*groups: str, user: int = 0, there: tuple[str, ...] = ()) -> tuple[subprocess.CompletedProcess[str], str]:
        program(folder / "id", f"echo {user}")
        program(folder / "apt-get", f'echo "$RUNLEVEL $*" >>{asked}')
        program(folder / "apt-cache", '[ "$2" = docker-cli ]')
        for name in there:
            program(folder / name, "[ $1 != compose ]")
        argv = ["/bin/sh", str(SCRIPT), *groups]
        bare = {"PATH": str(folder), "SBIN": str(folder), "DOCKER": str(folder / "docker")}
        done = subprocess.run(argv, env=bare, capture_output=True, text=True, timeout=30, check=False)
        return done, asked.read_text()

    return run


def test_what_tests_call_is_installed_without_starting_services(install: Install) -> None:
    done, asked = install("test")
    assert done.returncode == 0, done.stderr
    wanted = {"prometheus", "prometheus-alertmanager", "chromium", "docker-compose", "openssl", "git", "nftables"}
    assert wanted <= set(asked.splitlines()[1].split()) and asked.splitlines()[1].startswith("1 install ")


def test_other_users_get_one_command_for_all_groups(install: Install) -> None:
    done, asked = install("test", "containers", user=1000)
    assert done.returncode == 1 and asked == ""
    (line,) = done.stderr.splitlines()
    assert "sudo apt-get install" in line and line.split().count("prometheus") == 1
    assert {"chromium", "debootstrap"} <= set(line.split())


def test_an_engine_that_answers_is_kept_and_gets_compose(install: Install) -> None:
    """Another vendor's client without Compose."""
    asked = install("containers", there=("docker",))[1].splitlines()[1].split()
    assert "docker-compose" in asked and not {"docker.io", "docker-cli"} & set(asked)


def test_a_newer_distribution_has_the_client_apart(install: Install) -> None:
    asked = install("containers")[1].splitlines()[1].split()
    assert {"docker.io", "docker-cli"} <= set(asked) and "docker-buildx" not in asked


def test_pictures_get_letters_of_japanese(install: Install) -> None:
    asked = install("chromium", "japanese")[1].splitlines()[1].split()
    assert {"chromium", "fontconfig", "fonts-ipafont-gothic"} <= set(asked)


def test_nothing_to_do_asks_nobody(install: Install) -> None:
    assert install("chromium", there=("chromium-browser",))[1] == ""
    done, asked = install("colours")
    assert done.returncode == 2 and "colours" in done.stderr and asked == ""
