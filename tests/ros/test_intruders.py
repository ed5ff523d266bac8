"""People among real processes: who walks into an unmanned area stops its machine, as does its own hardware.

One mesh and one drive after the other: each begins armed, and ends latched or held.
"""

from collections.abc import Iterator

import pytest
from diagnostic_msgs.msg import DiagnosticStatus

from conftest import rearm, wait_until
from people_rig import MACHINE, NEAR, OUTSIDE, WALK, Site, people_site
from tms_machine import stamps

pytestmark = [pytest.mark.turns, pytest.mark.ros, pytest.mark.timeout(300)]


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Site]:
    with people_site(tmp_path_factory.mktemp("intruders")) as made:
        yield made


def test_a_walking_person_stops_the_machine_and_keeps_it_stopped(site: Site) -> None:
    drive = site.drive()
    wait_until(lambda: site.lamp == "automatic", 20, "its lamp says that it moves by itself")
    site.be(eye=WALK)
    receipt = site.stopped(drive, "INTRUDER_INSIDE")
    seen = [at for at, y in site.people if y < 20.7]
    print(f"stopped {stamps.seconds(receipt.stamp) - seen[0]:.3f} s after the first place inside was measured")
    assert site.refused_to_arm("INTRUDER_INSIDE") or site.people[-1][1] > 20.5 or site.people[-1][1] < -20.5
    wait_until(lambda: site.lamp == "stopped", 20, "its lamp says so")
    site.arm()  # once the area was seen free


def test_a_person_near_slows_it(site: Site) -> None:
    drive = site.drive()
    wait_until(lambda: site.speed > 0.5, 20, lambda: f"full speed: {site.speed}")
    site.be(eye=NEAR)
    wait_until(lambda: 0.05 < site.speed < 0.35, 20, lambda: f"slow: {site.speed}")
    warn = DiagnosticStatus.WARN
    wait_until(lambda: site.reports["people"].level == warn, 20, lambda: f"told: {site.reports}")
    assert "INTRUDER_NEAR" in site.reports["people"].message
    site.be(eye=OUTSIDE)
    wait_until(lambda: site.speed > 0.5, 20, lambda: f"full speed again: {site.speed}")
    site.be(eye=WALK)
    site.stopped(drive, "INTRUDER_INSIDE")


def test_a_tracker_that_falls_silent_stops_it(site: Site) -> None:
    drive = site.drive()
    site.be(eye={"silent": True})
    site.stopped(drive, "TRACKER_SILENT")
    assert site.refused_to_arm("TRACKER_SILENT")


def test_a_gate_that_was_opened_counts_until_a_person_has_looked(site: Site) -> None:
    drive = site.drive()
    site.be(gate={"open": True})
    site.stopped(drive, "GATE_OPENED")
    assert site.refused_to_arm("GATE_OPENED")
    site.be(gate={})
    wait_until(lambda: rearm(site.ros, MACHINE), 20, "armed", every=0.5)
    wait_until(lambda: bool(site.state.ready), 20, lambda: f"ready: {site.state}")


def test_its_own_emergency_stop_keeps_it_latched(site: Site) -> None:
    drive = site.drive()
    site.fault(hardware=["emergency_stop"])
    site.stopped(drive, "EMERGENCY_STOP_PRESSED")
    site.until("EMERGENCY_STOP_PRESSED")
    assert site.refused_to_arm("EMERGENCY_STOP_PRESSED")
    error = DiagnosticStatus.ERROR
    wait_until(lambda: site.reports["hardware"].level == error, 20, lambda: f"told: {site.reports}")
    hardware = site.reports["hardware"]
    said = {one.key: one.value for one in hardware.values}
    assert said == {"emergency_stop": "yes", "lock_lever": "no", "alive": "yes"}


@pytest.mark.parametrize(("source", "code"), [("lock_lever", "LEVER_LOCKED"), ("alive", "COUNTER_FROZEN")])
def test_what_passes_by_itself_stops_it_without_a_latch(site: Site, source: str, code: str) -> None:
    drive = site.drive()
    site.fault(hardware=[source])
    site.stopped(drive, code, latched=False)
    site.until(code)
    site.fault()
    wait_until(lambda: bool(site.state.ready), 20, lambda: f"ready: {site.state}")
    assert not site.state.latch
