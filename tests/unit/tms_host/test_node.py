"""What the host agent calls its PC."""

import pytest

from tms_host.node import ros_name


@pytest.mark.parametrize(
    ("host", "name"),
    [("Site-PC.example", "site_pc_example"), ("5e359c8e28cb", "pc_5e359c8e28cb"), ("", "pc_"), ("現場", "pc___")],
)
def test_every_host_has_a_name_that_ros_takes(host: str, name: str) -> None:
    assert ros_name(host) == name
