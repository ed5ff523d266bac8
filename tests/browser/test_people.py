"""A person walks into the unmanned area: the live map shows who is where, and the machine stops and says why."""

import re
from collections.abc import Iterator

import pytest
from playwright.sync_api import Page, expect

from people_rig import MACHINE, WALK, Site, people_site
from tms_config.config import load_site

pytestmark = [pytest.mark.turns, pytest.mark.browser, pytest.mark.timeout(300)]


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Site]:
    with people_site(tmp_path_factory.mktemp("people"), "ur") as made:
        yield made


def test_a_walking_person_stops_the_area_in_the_live_picture(site: Site, page: Page) -> None:
    drive = site.drive()
    page.goto(f"http://127.0.0.1:{load_site().file.ports.console}/#map")
    expect(page.locator("#map_box [data-area=yard]")).to_have_class(re.compile("unmanned"))
    expect(page.locator("#map_box .seen.person")).to_have_count(1)
    expect(page.locator("#map_box .lamp")).to_have_class(re.compile("automatic"))
    expect(page.locator("#watched")).to_contain_text("emergency stop: off")
    site.be(eye=WALK)
    expect(page.locator("#map_box .lamp")).to_have_class(re.compile("stopped"))
    site.stopped(drive, "INTRUDER_INSIDE")
    expect(page.locator("#watched")).to_contain_text(f"{MACHINE}: a person is in the unmanned area yard")
