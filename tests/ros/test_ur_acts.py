"""The console process audits what a person did at a gateway, also before the console was there."""

from pathlib import Path

import pytest
from builtin_interfaces.msg import Time
from tms_msg_db.msg import Event

from conftest import wait_until
from console_process import LIMIT, running
from tms_config.config import Site
from tms_ros.node import Ros
from tms_ur.audit_ledger import opened

pytestmark = pytest.mark.ros


def test_areas_that_were_enabled_are_in_the_audit(site: Site, ros: Ros, tmp_path: Path) -> None:
    machine = next(iter(site.file.machines))
    acts = ros.publisher(Event, f"/{machine}/rc/acts", depth=20, latched=True)
    acts.publish(Event(stamp=Time(sec=7), kind="enable_areas", node=f"{machine} 1234", text="T. Yamada"))
    with running(site, tmp_path):
        wait_until((site.state / "audit.acts").exists, LIMIT, "the act is noted")
        acts.publish(Event(stamp=Time(sec=7), kind="enable_areas", node=f"{machine} 1234", text="T. Yamada"))
    _, notes = opened(site.state / "audit.db")[0].waiting(10)
    assert [(one.kind, one.node, one.text) for one in notes] == [
        ("enable_areas", f"{machine} 1234", f"T. Yamada from {machine}:rc")
    ]
