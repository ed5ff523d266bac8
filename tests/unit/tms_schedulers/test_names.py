"""Which schedulers a site has, and whose task is whose."""

from pathlib import Path

import pytest
import yaml

from tms_config.config import Site, load_site
from tms_config.processes import table
from tms_schedulers.names import Scheduler, own, responsible, schedulers

PCS = {
    "cps": {"address": "10.9.0.10"},
    "machine": {"address": "10.9.0.20"},
    "sim": {"address": "10.9.0.30"},
    "north-2": {"address": "10.9.0.11", "roles": ["scheduler"], "machines": ["ic120_2", "ic120_3"]},
}
MACHINES = {"zx200": "zx200", "ic120_1": "ic120", "ic120_2": "ic120", "ic120_3": "ic120"}


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Site:
    for name in ("TMS_PC", "ROS_DOMAIN_ID"):
        monkeypatch.delenv(name, raising=False)
    path = tmp_path / "yard.yaml"
    machines = {name: {"model": model} for name, model in MACHINES.items()}
    services: dict[str, dict[str, str]] = {"db": {}, "ts": {}, "ur": {}, "host": {}}
    path.write_text(yaml.safe_dump({"name": "y", "domain": 8, "pcs": PCS, "services": services, "machines": machines}))
    return load_site(str(path))


def test_one_more_scheduler_on_each_pc_that_is_for_it(site: Site) -> None:
    rows = {row.full: row for row in table(site)}
    assert (rows["tms:ts"].pc, rows["tms:ts_north-2"].pc) == ("cps", "north-2")
    assert rows["tms:ts_north-2"].module == rows["tms:ts"].module == "tms_ts.node"
    assert schedulers(site) == (
        Scheduler("tms:ts", frozenset({"zx200", "ic120_1"})),
        Scheduler("tms:ts_north-2", frozenset({"ic120_2", "ic120_3"}), "/tms/ts_north_2"),
    )
    assert own(site, "tms:ts_north-2").named("cancel_run") == "/tms/ts_north_2/cancel_run"


@pytest.mark.parametrize(
    ("machines", "whose"),
    [
        (["ic120_3"], "tms:ts_north-2"),
        (["ic120_3", "ic120_2"], "tms:ts_north-2"),
        (["ic120_1", "ic120_2"], "tms:ts"),
        (["zx200"], "tms:ts"),
        ([], "tms:ts"),
    ],
)
def test_a_task_of_several_schedulers_machines_is_the_main_ones(site: Site, machines: list[str], whose: str) -> None:
    assert responsible(site, machines).process == whose


def test_a_scheduler_knows_its_own_runs(site: Site) -> None:
    main, north = schedulers(site)
    assert (main.suffix, north.suffix) == ("", "-north-2")
    assert main.owns("20260131-060000-1a2b") and not north.owns("20260131-060000-1a2b")
    assert north.owns("20260131-060000-1a2b-north-2") and not main.owns("20260131-060000-1a2b-north-2")


def test_a_site_on_one_pc_has_one() -> None:
    site = load_site()
    assert schedulers(site) == (Scheduler("tms:ts", frozenset(site.file.machines)),)
    assert own(site, "tms:ts").named("runs") == "/tms/runs"
