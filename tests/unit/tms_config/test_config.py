"""Configuration errors name the file, the key and what is wrong."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import yaml

from conftest import site_data
from tms_config.config import CONFIGS, load_site
from tms_config.models import MachineModel
from tms_config.processes import find, table
from tms_config.reasons import (
    AndMore,
    BadConfig,
    BadFile,
    BadKey,
    BadLine,
    BadVariable,
    CannotBeRead,
    FormNotSaid,
    HalfALogin,
    KeyTwice,
    NoBorder,
    NoCodeFile,
    NoDomain,
    NoKey,
    NoMachine,
    NoMapping,
    NoModel,
    NoMover,
    NoParent,
    NoProcess,
    NoResponse,
    NoService,
    NoSourceFacts,
    NoSuchLink,
    NotConvex,
    NoTopic,
    NotUnderMachines,
    NotUtf8,
    NoUri,
    NoYaml,
    PasswordInUri,
    ProcessMeant,
    SeveralProcesses,
    SharedFrames,
    TwoPlanners,
    UserTwice,
)
from tms_config.yaml_file import parse, read_yaml
from tms_reason.errors import ConfigError
from tms_reason.reason import Reason
from tms_reason.reasons import (
    BadSetting,
    BadValueOf,
    MissingKey,
    MustBeAbove,
    MustBeAtMost,
    MustBeOneOf,
    MustBeWhole,
    MustFitPattern,
    UnknownKey,
)
from tms_reason.texts import text
from tms_reason.wire import to_line


def site(folder: Path, **changes: object) -> str:
    file = folder / "site.yaml"
    file.write_text(yaml.safe_dump(site_data(50, 20000, **changes)))
    return str(file)


@pytest.fixture(autouse=True)
def clean_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("ROS_DOMAIN_ID", "TMS_SITE", "TMS_STATE", "TMS_MONGODB_URI"):
        monkeypatch.delenv(name, raising=False)


def refused(*args: object, **changes: object) -> Reason:
    """Why a site is refused."""
    with pytest.raises(ConfigError) as caught:
        load_site(*args, **changes)  # type: ignore[arg-type]
    return caught.value.reason


PATTERN = MustFitPattern("^[a-z][a-z0-9_]*$")
MODELS = ("d37pxi", "ic120", "mst110cr", "mst2200", "zx120", "zx200")


@pytest.mark.parametrize(
    ("changes", "key", "problem"),
    [
        ({"colour": "red"}, "colour", UnknownKey()),
        ({"ports": {"metric": 9000}}, "ports.metric", UnknownKey()),
        ({"domain": 102}, "domain", BadValueOf(MustBeAtMost("101"), "102")),
        ({"domain": "many"}, "domain", BadValueOf(MustBeWhole(), "'many'")),
        ({"machines": {"zx200": {"model": "zx999"}}}, "machines.zx200.model", NoModel("zx999", MODELS)),
        ({"machines": {"zx200": {}}}, "machines.zx200.model", MissingKey()),
        ({"machines": {"ZX200": {"model": "zx200"}}}, "machines.ZX200.[key]",
         BadValueOf(PATTERN, "'ZX200'")),
        ({"machines": {"zx 200": {"model": "zx200"}}}, "machines.zx 200.[key]",
         BadValueOf(PATTERN, "'zx 200'")),
        ({"sim": {"speed": 0}}, "sim.speed", BadValueOf(MustBeAbove("0.0"), "0")),
        ({"backend": "real"}, "backend", BadValueOf(MustBeOneOf("'sim', 'opera', 'physx'"), "'real'")),
    ],
)  # fmt: skip
def test_wrong_site(tmp_path: Path, changes: dict[str, object], key: str, problem: Reason) -> None:
    file = site(tmp_path, **changes)
    found = refused(file)
    assert isinstance(found, BadKey)
    assert (found.file, found.key, found.problem) == (file, key, problem)
    named = [part for part in key.split(".") if part != "[key]"][-1 if problem != MissingKey() else -2]
    assert named in Path(file).read_text().splitlines()[found.line - 1]


def test_all_problems_of_a_file_are_named_up_to_a_bound(tmp_path: Path) -> None:
    found = refused(site(tmp_path, **{f"colour_{n}": n for n in range(7)}))
    assert isinstance(found, BadConfig) and found.problems[-1] == AndMore(2)
    assert [one.key for one in found.problems if isinstance(one, BadKey)] == [f"colour_{n}" for n in range(5)]
    assert "\n" not in text(found, "en")


def test_lists_and_missing_keys_have_lines(tmp_path: Path) -> None:
    file = tmp_path / "site.yaml"
    file.write_text("name: t\ndomain: 1\nservices: {}\npcs:\n  a:\n    address: b\n    roles:\n    - cps\n    - king\n")
    found = refused(str(file))
    assert isinstance(found, BadKey) and (found.key, found.line) == ("pcs.a.roles.1", 9)
    file.write_text("name: t\ndomain: 1\n")
    found = refused(str(file))
    assert found == BadKey(str(file), 1, "services", MissingKey())


@pytest.mark.parametrize(
    ("text", "line", "problem"),
    [
        ("a: 1\na: 2\n", 2, KeyTwice("a")),
        ("a: [1\n", 2, NoYaml("did not find expected ',' or ']'")),
        ("a: \x07\n", None, NoYaml("unacceptable character #x0007: control characters are not allowed")),
        ("a: {{ b }}\n", 1, NoKey()),
        ("a: !!python/object:os.system {}\n", 1,
         NoYaml("could not determine a constructor for the tag 'tag:yaml.org,2002:python/object:os.system'")),
    ],
)  # fmt: skip
def test_wrong_yaml(tmp_path: Path, text: str, line: int | None, problem: Reason) -> None:
    file = tmp_path / "x.yaml"
    file.write_text(text)
    with pytest.raises(ConfigError) as caught:
        read_yaml(file)
    place = BadFile(str(file), problem) if line is None else BadLine(str(file), line, problem)
    assert caught.value.reason == place


def test_missing_binary_and_other_files(tmp_path: Path) -> None:
    file = tmp_path / "none.yaml"
    assert refused(str(file)) == BadFile(str(file), CannotBeRead("No such file or directory"))
    file.write_bytes(b"\xff\xfe\x00")
    assert refused(str(file)) == BadFile(str(file), NotUtf8())
    file.write_text("- a list\n")
    assert refused(str(file)) == BadFile(str(file), NoMapping())


def test_a_file_is_read_anew_when_its_text_has_changed(tmp_path: Path) -> None:
    file = tmp_path / "site.yaml"
    file.write_text(yaml.safe_dump(site_data(70, 20000)))
    first, again = load_site(str(file)), load_site(str(file))
    file.write_text(yaml.safe_dump(site_data(71, 20000)))
    assert (again.file is first.file, first.domain, load_site(str(file)).domain) == (True, 70, 71)


def test_environment_wins_over_the_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "7")
    monkeypatch.setenv("TMS_STATE", str(tmp_path / "s"))
    loaded = load_site(site(tmp_path))
    assert (loaded.domain, loaded.state) == (7, tmp_path / "s")
    monkeypatch.setenv("ROS_DOMAIN_ID", "200")
    assert refused(site(tmp_path)) == BadVariable("ROS_DOMAIN_ID", NoDomain("200"))


URI = "mongodb://db1,db2:27018"


@pytest.mark.parametrize(
    ("given", "key", "problem"),
    [
        ({"uri": "mongodb://anna:s3cret@db1"}, "store.uri", PasswordInUri()),
        ({"uri": URI, "user": "anna"}, "store", HalfALogin()),
        ({"uri": URI, "password_file": "x"}, "store", HalfALogin()),
        ({"user": "anna", "password_file": "x"}, "store", NoUri()),
        ({"tls_ca": "x"}, "store", NoUri()),
        ({"uri": "mongodb://anna@db1", "user": "anna", "password_file": "x"}, "store.user", UserTwice()),
        ({"password": "s3cret"}, "store.password", UnknownKey()),
    ],
)
def test_what_a_site_may_not_say_about_its_store(
    tmp_path: Path, given: dict[str, object], key: str, problem: Reason
) -> None:
    found = refused(site(tmp_path, store=given))
    assert isinstance(found, BadKey) and (found.key, found.problem) == (key, problem)
    assert "s3cret" not in to_line(found)


def test_no_reason_shows_what_stands_under_password_or_uri(tmp_path: Path) -> None:
    for name in ("uri", "password_file"):
        found = refused(site(tmp_path, store={name: 12345}))
        assert isinstance(found, BadKey) and isinstance(found.problem, BadSetting)
        assert "12345" not in to_line(found)


def test_the_backend_chooses_the_names(tmp_path: Path) -> None:
    machines = {"zx200": {"model": "zx200"}, "ic120_1": {"model": "ic120"}, "ic120_2": {"model": "ic120"}}
    names = {
        backend: load_site(site(tmp_path, machines=machines, backend=backend)) for backend in ("sim", "opera", "physx")
    }
    assert [names[one].border("zx200").joint_states for one in names] == ["joint_states", "joint_states", "joint_state"]
    assert names["physx"].border("ic120_2").cmd_vel == "tracks/cmd_vel"
    assert {names["sim"].border(f"ic120_{i}").frame_prefix for i in (1, 2)} == {"ic120_1_tf/", "ic120_2_tf/"}
    as_physx = load_site(site(tmp_path, machines=machines, sim={"names": "physx"}))
    assert names["physx"].border("zx200").controller == "ours"
    assert any(row.full == "zx200:mc" for row in table(names["physx"]))
    theirs = names["physx"].border("zx200").model_copy(update={"controller": "theirs"})
    assert as_physx.border("zx200") == theirs  # a stand-in has controllers of its own
    assert not any(row.name == "mc" for row in table(as_physx))
    assert any(row.full == "sim:zx200" for row in table(as_physx))


@pytest.mark.parametrize(
    ("changes", "key", "problem"),
    [
        ({"backend": "opera", "machines": {"a": {"model": "zx200"}, "b": {"model": "zx200"}}}, "machines.b",
         SharedFrames("a", "b", "")),
        ({"sim": {"faults": {"ic120": {"late": 1}}}}, "sim.faults.ic120", NotUnderMachines("ic120", ("zx200",))),
        ({"sim": {"faults": {"zx200": {"lat": 1}}}}, "sim.faults.zx200.lat", UnknownKey()),
        ({"peers": {"ic120": {"leaf": "v5"}}}, "peers.ic120", NotUnderMachines("ic120", ("zx200",))),
        ({"peers": {"zx200": {"leaf": "v6b", "planner": "theirs"}}}, "peers.zx200.planner",
         FormNotSaid("TmsRpExcavator")),
        ({"peers": {"zx200": {"leaf": "v6b", "planner": "theirs", "motions": True}},
          "forms": {"TmsRpExcavator": "plan"}}, "peers.zx200.planner", TwoPlanners()),
    ],
)  # fmt: skip
def test_machines_that_do_not_fit(tmp_path: Path, changes: dict[str, object], key: str, problem: Reason) -> None:
    found = refused(site(tmp_path, **changes))
    assert isinstance(found, BadKey) and (found.key, found.problem) == (key, problem)


def test_peers_of_version_6_get_a_border_on_the_pc_of_their_machine(tmp_path: Path) -> None:
    machines = {name: {"model": "zx200"} for name in ("old", "early", "new", "alone")}
    peers = {"old": {"leaf": "v5"}, "early": {"leaf": "v6a"}, "new": {"leaf": "v6b"}}
    assert forms(tmp_path, machines=machines, peers=peers) == {
        "early:if": "v6a", "new:if": "v6b", "tms:if_readers": "both",
    }  # fmt: skip


@pytest.mark.parametrize("form", ["param_type", "both"])
def test_records_are_read_in_the_form_that_the_site_names(tmp_path: Path, form: str) -> None:
    assert forms(tmp_path, forms={"TmsdbGetData": form}) == {"tms:if_readers": form}


def test_a_planner_speaks_the_form_of_its_peers(tmp_path: Path) -> None:
    assert forms(tmp_path, forms={"TmsRpExcavator": "plan"}) == {}  # the usual one
    assert forms(tmp_path, forms={"TmsRpExcavator": "plans"}) == {"zx200:rp": "plans"}


def forms(tmp_path: Path, **changes: object) -> dict[str, str]:
    return {row.full: row.form for row in table(load_site(site(tmp_path, **changes))) if row.form}


def test_a_model_without_the_border_of_the_site(tmp_path: Path) -> None:
    file = site(tmp_path, backend="physx", machines={"d": {"model": "d37pxi"}})
    found = refused(file)
    assert isinstance(found, BadKey) and found.file.endswith("configs/machines/d37pxi.yaml")
    assert (found.key, found.problem) == ("borders", NoBorder("physx", file))


@pytest.mark.parametrize(
    ("change", "key", "path"),
    [
        ({"planner": "crane"}, "planner", "tms_rp/kinds/crane/__init__.py"),
        ({"subtasks": {"wave": "wave_the_flag"}}, "subtasks.wave", "tms_subtasks/wave_the_flag.py"),
    ],
)
def test_a_model_that_names_code_that_is_not_there(tmp_path: Path, change: dict[str, Any], key: str, path: str) -> None:
    loaded = load_site(site(tmp_path))
    models = {"zx200": loaded.models["zx200"].model_copy(update=change)}
    with pytest.raises(ConfigError) as caught:
        table(replace(loaded, models=models))
    found = caught.value.reason
    assert isinstance(found, BadKey) and found.file.endswith("configs/machines/zx200.yaml")
    assert (found.key, found.problem) == (key, NoCodeFile(path))


def test_a_machine_without_a_planner_has_no_planning_process(tmp_path: Path) -> None:
    names = {row.full for row in table(load_site(site(tmp_path, machines={"d": {"model": "d37pxi"}})))}
    assert "d:rc" in names and "d:rp" not in names


def test_one_line_adds_a_machine(tmp_path: Path) -> None:
    machines = {"zx200": {"model": "zx200"}, "zx200_2": {"model": "zx200"}}
    names = {row.full for row in table(load_site(site(tmp_path, machines=machines)))}
    assert {"zx200_2:rc", "zx200_2:rp", "sim:zx200_2", "zx200_2:subtask_zx200_change_pose"} <= names


@pytest.mark.parametrize(
    ("name", "full"),
    [("zx200:rc", "zx200:rc"), ("sample_boom", "zx200:st_zx200_sample_boom"), ("zx200:sample_boom",
     "zx200:st_zx200_sample_boom"), ("db", "tms:db")],
)  # fmt: skip
def test_a_part_of_a_name_is_enough(tmp_path: Path, name: str, full: str) -> None:
    assert find(load_site(site(tmp_path)), name).full == full


def test_names_that_fit_none_or_several(tmp_path: Path) -> None:
    loaded = load_site(site(tmp_path))
    follow = tuple(f"zx200:{name}" for name in ("st_zx200_follow_waypoints", "st_zx200_follow_waypoints_deg"))
    for name, reason in (
        ("follow_way", SeveralProcesses("follow_way", (*follow, "zx200:primitive_excavator_follow_waypoints"))),
        ("zx20:rc", ProcessMeant("zx20:rc", "zx200:rc")),
        ("nothing_like_it", NoProcess("nothing_like_it")),
    ):
        with pytest.raises(ConfigError) as caught:
            find(loaded, name)
        assert caught.value.reason == reason


def test_a_machine_or_a_bridge_that_the_site_does_not_have(tmp_path: Path) -> None:
    loaded = load_site(site(tmp_path))
    with pytest.raises(ConfigError) as caught:
        loaded.model_of("zx1")
    assert isinstance(caught.value.reason, BadKey)
    assert caught.value.reason.problem == NoMachine("zx1", ("zx200",))
    with pytest.raises(ConfigError) as caught:
        _ = loaded.bridge
    assert isinstance(caught.value.reason, BadKey) and isinstance(caught.value.reason.problem, NoService)


def test_unknown_service(tmp_path: Path) -> None:
    with pytest.raises(ConfigError) as caught:
        table(load_site(site(tmp_path, services={"dbx": {}})))
    found = caught.value.reason
    assert isinstance(found, BadKey) and found.key == "services.dbx"
    assert found.problem == NoService("dbx", ("db", "sp", "ts", "ur", "if", "host"))


def test_the_bridge_has_settings_of_its_own(tmp_path: Path) -> None:
    text = "name: t\ndomain: 1\nservices: {if: %s}\n"
    file = tmp_path / "site.yaml"
    file.write_text(text % "{}")
    bridge = load_site(str(file)).bridge
    assert (bridge.bind, bridge.port, bridge.joint_cmd, bridge.role) == ("127.0.0.1", 10000, "plain", "sim")
    for settings, key in (("{port: 80}", "port"), ("{colour: red}", "colour"), ("{joint_cmd: both}", "joint_cmd")):
        file.write_text(text % settings)
        found = refused(str(file))
        assert isinstance(found, BadKey) and (found.key, found.line) == (f"services.if.{key}", 3)


@pytest.mark.parametrize(
    ("change", "key", "problem"),
    [
        ("response: {}", "response", NoResponse("swing_joint")),
        ("initial: {tail_joint: 0}", "", NoSuchLink("tail_joint")),
        ("blade: {link: tail_link, edge: [0, 0], width: 3, force: 1, origin: o}", "", NoSuchLink("tail_link")),
        ("bucket: {link: bucket_link, section: [[0, 0], [1, 0], [0.4, 0.1], [0, 1]], width: 1, force: 1, origin: o}",
         "bucket.section", NotConvex()),
        ("borders: {sim: {odom: odom}}", "borders.sim.sources.odom", NoSourceFacts()),
        ("borders: {sim: {sources: {odom: {period: 0.1, stamps: utc, frozen_after: 1, origin: o}}}}",
         "borders.sim.sources.odom", NoTopic("odom")),
        ("geometry: {boom_joint: {parent: sky, child: boom_link, xyz: [0, 0, 0]}}\nshapes: {}\nbucket: null\n"
         "solids: []",
         "geometry.boom_joint", NoParent("sky")),
    ],
)  # fmt: skip
def test_a_machine_file_that_does_not_fit_together(tmp_path: Path, change: str, key: str, problem: Reason) -> None:
    data = yaml.safe_load((CONFIGS / "machines" / "zx200.yaml").read_text())
    file = tmp_path / "zx200.yaml"
    file.write_text(yaml.safe_dump({**data, **yaml.safe_load(change)}, sort_keys=False))
    with pytest.raises(ConfigError) as caught:
        parse(file, MachineModel)
    found = caught.value.reason
    if key:
        assert isinstance(found, BadKey) and (found.key, found.problem) == (key, problem)
    else:
        assert found == BadFile(str(file), problem)


def test_a_response_of_what_does_not_move(tmp_path: Path) -> None:
    data = yaml.safe_load((CONFIGS / "machines" / "zx200.yaml").read_text())
    data["response"]["tail"] = data["response"]["drive"]
    file = tmp_path / "zx200.yaml"
    file.write_text(yaml.safe_dump(data))
    with pytest.raises(ConfigError) as caught:
        parse(file, MachineModel)
    found = caught.value.reason
    assert isinstance(found, BadKey) and (found.key, found.problem) == ("response.tail", NoMover("tail"))
