"""Which nodes of other systems are understood: by the hash that they tell, and by the site file."""

from types import SimpleNamespace
from typing import Any

import pytest

from tms_machine.leaf_forms import misfit
from tms_machine.peer_forms import HASHES as ALL
from tms_machine.peer_forms import judged
from tms_machine.reasons import FormContradicted, FormUnknown
from tms_reason.reason import Reason

HASHES = ALL["LeafNodeBase"]
SILENT = "INVALID"  # what rclpy makes of an endpoint without a hash, as nodes of Humble have
OTHER = "RIHS01_" + 64 * "0"


@pytest.mark.parametrize(
    ("told", "declared", "why"),
    [
        (HASHES["v5"], "", None),  # undeclared: version 5, if it tells so itself
        (SILENT, "", FormUnknown("/peer", "LeafNodeBase", "zx200")),
        (HASHES["v6b"], "", FormContradicted("/peer", "LeafNodeBase", "v6b", "v5", "zx200")),
        (SILENT, "v5", None),  # declared: a hash can only contradict
        (SILENT, "v6a", None),
        (HASHES["v6a"], "v6a", None),
        (HASHES["v6a"], "v6b", FormContradicted("/peer", "LeafNodeBase", "v6a", "v6b", "zx200")),
        (OTHER, "v6b", FormContradicted("/peer", "LeafNodeBase", "?", "v6b", "zx200")),
    ],
)
def test_a_peer_is_refused_that_would_be_misread(told: str, declared: str, why: Reason | None) -> None:
    assert judged(told, "/peer", "zx200", "LeafNodeBase", declared) == why


@pytest.mark.parametrize("servers", [True, False])
def test_it_is_the_other_side_that_is_looked_at(servers: bool) -> None:
    def ends(topic: str, no_mangle: bool) -> list[Any]:
        assert topic == "rq/zx200/dig/_action/send_goalRequest" and no_mangle
        return [SimpleNamespace(node_namespace="/", node_name=name, topic_type_hash=told)
                for name, told in (("own", SILENT), ("ours", HASHES["v5"]), ("humble", SILENT))]  # fmt: skip

    def none(*_: Any, **__: Any) -> list[Any]:
        return []

    looks = {"get_publishers_info_by_topic": none, "get_subscriptions_info_by_topic": none}
    looks["get_subscriptions_info_by_topic" if servers else "get_publishers_info_by_topic"] = ends
    node = SimpleNamespace(**looks, get_fully_qualified_name=lambda: "/own")
    site: Any = SimpleNamespace(file=SimpleNamespace(peers={}))
    ros: Any = SimpleNamespace(node=node)
    assert misfit(ros, site, "zx200", "dig", servers=servers) == FormUnknown("/humble", "LeafNodeBase", "zx200")
    site.file.peers["zx200"] = SimpleNamespace(leaf="v5")
    assert misfit(ros, site, "zx200", "dig", servers=servers) is None
