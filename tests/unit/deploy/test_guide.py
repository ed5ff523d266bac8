"""The site guide says the same in both languages, and its `make` commands do what it says of them."""

import re

import pytest

from conftest import PROJECT

GUIDE = (PROJECT / "deploy" / "README.md").read_text(encoding="utf-8")
JAPANESE, ENGLISH = GUIDE.split("\n# English\n")


def commands(text: str) -> list[str]:
    blocks = re.findall(r"```sh\n(.*?)```", text, re.DOTALL)
    return [line.split("#")[0].strip() for block in blocks for line in block.splitlines()]


def row(text: str, beginning: str) -> str:
    (found,) = [line for line in text.splitlines() if line.startswith(f"| {beginning} |")]
    return found


def test_both_languages_have_the_same_commands() -> None:
    assert len(commands(JAPANESE)) > 10
    assert commands(JAPANESE) == commands(ENGLISH)


@pytest.mark.parametrize("line", [line for line in commands(ENGLISH) if re.match("make (?!bundle)", line)])
def test_every_make_command_of_a_mesh_names_its_site(line: str) -> None:
    assert "SITE=" in line, "otherwise it asks the demo"


@pytest.mark.parametrize(("text", "name"), [(JAPANESE, "更新"), (ENGLISH, "update")])
def test_an_update_starts_what_runs_anew(text: str, name: str) -> None:
    """`make up` leaves a mesh that runs as it is."""
    reported = re.findall(r"`([^`]*)`", row(text, name))
    down, up = reported.index("make down SITE=genba"), reported.index("make up SITE=genba ROLE=cps")
    assert reported[0] == "git pull" and down < up
    assert reported.index("make setup") < reported.index("sudo systemctl restart tms@cps")


@pytest.mark.parametrize("text", [JAPANESE, ENGLISH])
def test_the_user_of_the_containers_is_that_of_the_image(text: str) -> None:
    (number,) = re.findall(r"chown (\d+) configs/sites/users.yaml", text)
    assert f"\nUSER {number}\n" in (PROJECT / "deploy" / "Dockerfile").read_text()
