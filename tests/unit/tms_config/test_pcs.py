"""A site of several PCs: who runs what, under which address, and every mistake in it."""

import os
from pathlib import Path
from typing import Any

import pytest
import yaml

from tms_config.config import CHOICE, Site, load_site
from tms_config.processes import here, table
from tms_config.reasons import (
    BadConfig,
    BadKey,
    ManyPcsFor,
    NoAddress,
    NoCps,
    NoPcFor,
    NoRole,
    NoSuchPc,
    NotUnderMachines,
    WhichPc,
)
from tms_config.site_file import ROLES
from tms_reason.errors import ConfigError
from tms_reason.reason import Reason
from tms_reason.reasons import MissingKey, UnknownKey
from tms_runtime.environment import enter, environment

PCS = {
    "cps": {"address": "10.9.0.10"},
    "machine": {"address": "10.9.0.20"},
    "sim": {"address": "10.9.0.30"},
}


@pytest.fixture(autouse=True)
def clean(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    for name in ("TMS_PC", "ROS_DOMAIN_ID", "TMS_MONGODB_URI"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("TMS_STATE", str(tmp_path / "state"))


def site(tmp_path: Path, **changes: Any) -> Site:
    data = {
        "name": "yard",
        "domain": 80,
        "pcs": PCS,
        "services": {"db": {}, "ts": {}, "ur": {}, "host": {}},
        "machines": {"zx200": {"model": "zx200"}, "ic120_1": {"model": "ic120"}},
        **changes,
    }
    path = tmp_path / "yard.yaml"
    path.write_text(yaml.safe_dump(data, sort_keys=False))
    return load_site(str(path))


def test_every_process_has_one_pc_and_its_address(tmp_path: Path) -> None:
    rows = {row.full: row for row in table(site(tmp_path))}
    assert (rows["tms:ts"].pc, rows["tms:ts"].address) == ("cps", "10.9.0.10")
    assert (rows["zx200:rc"].pc, rows["sim:zx200"].pc) == ("machine", "sim")
    assert [name for name in rows if name.startswith("tms:host")] == [
        "tms:host_cps",
        "tms:host_machine",
        "tms:host_sim",
    ]
    assert rows["tms:host_sim"].pc == "sim"
    assert len({(row.address, row.port) for row in rows.values()}) == len(rows)


def test_a_pc_runs_its_own_rows_only(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TMS_PC", "sim")
    assert {row.full for row in here(site(tmp_path))} == {"tms:host_sim", "sim:zx200", "sim:ic120_1"}


def test_the_choice_of_the_last_start_holds(tmp_path: Path) -> None:
    state = tmp_path / "state"
    state.mkdir()
    (state / CHOICE).write_text("machine")
    assert site(tmp_path).pc == "machine"


def test_two_machine_pcs_share_the_machines(tmp_path: Path) -> None:
    more = {**PCS, "truck": {"address": "10.9.0.21", "roles": ["machine"], "machines": ["ic120_1"]}}
    rows = {row.full: row.pc for row in table(site(tmp_path, pcs=more))}
    assert (rows["zx200:rc"], rows["ic120_1:rc"]) == ("machine", "truck")


def test_dds_uses_the_pcs_address_and_loopback(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TMS_PC", "machine")
    profile = Path(environment(site(tmp_path))["FASTRTPS_DEFAULT_PROFILES_FILE"]).read_text()
    assert "<address>10.9.0.20</address><address>127.0.0.1</address>" in profile
    assert "<avoid_builtin_multicast>true</avoid_builtin_multicast>" in profile  # a network may lose multicast
    assert "initialPeersList" not in profile  # which names processes of one PC


@pytest.mark.parametrize(("pcs", "told"), [(PCS, "SUBNET"), ({}, "SYSTEM_DEFAULT")], ids=["several PCs", "one PC"])
def test_processes_of_several_pcs_tell_all_others(
    pcs: dict[str, object], told: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TMS_PC", "machine")
    with monkeypatch.context() as patch:
        patch.setattr(os, "environ", dict(os.environ))
        enter(site(tmp_path, pcs=pcs), tells_few=True)
        assert os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] == told


def test_a_discovery_server_runs_on_the_cps_pc(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TMS_PC", "machine")
    found = site(tmp_path, network={"discovery": "server", "port": 11900})
    assert environment(found)["ROS_DISCOVERY_SERVER"] == "10.9.0.10:11900"
    assert {row.full: row.pc for row in table(found)}["tms:discovery"] == "cps"


def test_a_site_of_one_pc_may_have_one_too(tmp_path: Path) -> None:
    found = site(tmp_path, pcs={}, network={"discovery": "server", "port": 11900})
    assert environment(found)["ROS_DISCOVERY_SERVER"] == "127.0.0.1:11900"
    assert "tms:discovery" in {row.full for row in table(found)}


@pytest.mark.parametrize(
    ("changes", "key", "problem"),
    [
        ({"pcs": {"cps": PCS["cps"], "sim": PCS["sim"]}}, "pcs", NoPcFor("zx200:rc", "machine")),
        ({"pcs": {**PCS, "b": {"address": "10.9.0.4", "roles": ["cps"]}}}, "pcs",
         ManyPcsFor(("cps", "b"), "tms:store", "cps")),
        ({"pcs": {**PCS, **{pc: {"address": "a", "roles": ["scheduler"], "machines": ["zx200"]} for pc in ("b", "c")}}},
         "pcs", ManyPcsFor(("b", "c"), "tasks of zx200", "scheduler")),
        ({"pcs": {**PCS, "spare": {"address": "10.9.0.4"}}}, "pcs.spare", NoRole(ROLES)),
        ({"pcs": {**PCS, "machine": {"address": "a", "machines": ["zx9"]}}}, "pcs.machine.machines",
         NotUnderMachines("zx9", ("zx200", "ic120_1"))),
        ({"pcs": {"sim": PCS["sim"]}, "network": {"discovery": "server"}}, "network.discovery", NoCps()),
    ],
)  # fmt: skip
def test_a_mistake_is_named_with_file_and_key(
    tmp_path: Path, changes: dict[str, Any], key: str, problem: Reason
) -> None:
    with pytest.raises(ConfigError) as caught:
        table(site(tmp_path, **changes))
    found = caught.value.reason
    assert isinstance(found, BadKey) and found.file == str(tmp_path / "yard.yaml")
    assert (found.key, found.problem) == (key, problem)


def test_an_address_that_is_misspelt_and_therefore_missing(tmp_path: Path) -> None:
    with pytest.raises(ConfigError) as caught:
        site(tmp_path, pcs={**PCS, "cps": {"adress": "10.9.0.4"}})
    found = caught.value.reason
    assert isinstance(found, BadConfig)
    keys = [(one.key, one.problem) for one in found.problems if isinstance(one, BadKey)]
    assert keys == [("pcs.cps.address", MissingKey()), ("pcs.cps.adress", UnknownKey())]


def test_nothing_starts_before_it_is_known_which_pc_this_is(tmp_path: Path) -> None:
    with pytest.raises(ConfigError) as caught:
        here(site(tmp_path))
    assert caught.value.reason == WhichPc("yard", ("cps", "machine", "sim"))


def test_an_unknown_pc_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TMS_PC", "cpss")
    with pytest.raises(ConfigError) as caught:
        site(tmp_path)
    found = caught.value.reason
    assert isinstance(found, BadKey) and found.problem == NoSuchPc("cpss", ("cps", "machine", "sim"))


def test_a_name_that_nobody_knows_is_no_address(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TMS_PC", "cps")
    found = site(tmp_path, pcs={**PCS, "cps": {"address": "no-such-pc.invalid"}})
    with pytest.raises(ConfigError) as caught:
        environment(found)
    reason = caught.value.reason
    assert isinstance(reason, BadKey) and isinstance(reason.problem, NoAddress)
    assert reason.problem.name == "no-such-pc.invalid"
