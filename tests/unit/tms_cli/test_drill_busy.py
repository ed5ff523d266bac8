"""What the logs of a machine's processes tell of a PC that did not run them."""

from datetime import datetime
from pathlib import Path

import pytest

from tms_cli.drill.busy import stood_still
from tms_config.config import Site, load_site
from tms_host.supervisor import log_file

AT = datetime(2026, 1, 31, 6, 0, 10).timestamp()  # local time, as the logs have it
LINE = "2026-01-31T06:00:{} WARNING process={} machine=zx200 event=stood_still seconds={} waited={}\n"


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Site:
    monkeypatch.setenv("TMS_STATE", str(tmp_path))
    return load_site()


def say(site: Site, process: str, *lines: str) -> None:
    path = log_file(site, process)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("2026-01-31T06:00:09.900 INFO process=x event=armed\n" + "".join(lines), encoding="utf-8")


@pytest.mark.parametrize(("process", "seconds"), [("zx200:rc", "09.000"), ("zx200:rp", "10.800"), ("tms:ts", "09.990")])
def test_a_process_behind_the_machine_that_stood_still_then_is_named(site: Site, process: str, seconds: str) -> None:
    say(site, process, LINE.format(seconds, process, "0.62", "0.50"))
    assert stood_still(site, "zx200", [AT - 60.0, AT]) == f"this PC did not run {process} for 0.5 of 0.6 s"
    assert not stood_still(site, "zx200", [AT - 60.0]) and not stood_still(site, "zx200", [])


def test_another_time_or_another_machine_is_no_reason(site: Site) -> None:
    say(site, "zx200:rc", *(LINE.format(at, "zx200:rc", "0.62", "0.50") for at in ("08.000", "12.500")))
    say(site, "ic120:rc", LINE.format("10.000", "ic120:rc", "0.62", "0.50"))
    say(site, "tms:db", LINE.format("10.000", "tms:db", "0.62", "0.50"))
    assert not stood_still(site, "zx200", [AT])


def test_a_long_callback_is_no_fault_of_the_pc(site: Site) -> None:
    say(site, "zx200:rc", LINE.format("10.000", "zx200:rc", "0.62", "0.20"))
    assert not stood_still(site, "zx200", [AT])
