"""The pictures of the console: small, of pages that there are, and those that README shows among them."""

import re

from PIL import Image

from conftest import PROJECT
from pictures import LARGEST, PICTURES, SIZE
from tms_ur.api import STATIC

PAGES = set(re.findall(r'"p_(\w+)"', (STATIC / "words.js").read_text(encoding="utf-8")))


def test_pictures_are_small_and_of_pages_that_there_are() -> None:
    for file in PICTURES.iterdir() if PICTURES.exists() else ():
        assert file.name.split(".")[0] in PAGES, file
        assert file.stat().st_size <= LARGEST, file
        with Image.open(file) as picture:
            assert picture.size == (SIZE["width"], SIZE["height"]), file


def test_readme_shows_pages_that_there_are() -> None:
    for name in ("README.md", "README.ja.md"):
        shown = re.findall(r"\(deploy/pictures/(\w+)[.\w]*\.png\)", (PROJECT / name).read_text(encoding="utf-8"))
        assert 2 <= len(shown) and set(shown) <= PAGES
