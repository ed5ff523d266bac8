"""The page about nodes names every node of the C++ system that the palette has, with the versions that have it."""

import re

from conftest import PROJECT
from tms_ts.bt import registry

PAGE = (PROJECT / "configs" / "tasks" / "NODES.md").read_text("utf-8")


def test_the_page_and_the_palette_are_one() -> None:
    listed: dict[str, tuple[int, ...]] = {}
    for names, versions in re.findall(r"^\| (`.+?`) \| ([-56, ]+) \|", PAGE, re.MULTILINE):
        listed |= dict.fromkeys(re.findall(r"\w+", names), tuple(map(int, re.findall(r"[56]", versions))))
    known = {name: cls.versions for name, cls in registry().items() if not cls.builtin}
    assert listed == {name: versions for name, versions in known.items() if versions or name in listed}
