"""`tms check` says what is wrong in a machine file, where, and why it matters."""

import copy
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml

from conftest import site_data
from tms_areas.reasons import TrackersNeedAreas
from tms_cli.commands import check
from tms_config import config
from tms_config.reasons import BadConfig, NoMover, NoResponse, NoSourceFacts, NoTopic
from tms_reason.reason import Reason
from tms_reason.reasons import BadValueOf, MissingKey

MODEL = yaml.safe_load((config.CONFIGS / "machines" / "zx200.yaml").read_text(encoding="utf-8"))


@pytest.fixture
def checked(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, tms: Any) -> Callable[[dict[str, Any]], Any]:
    """What the verb says about a site whose zx200 is this one."""
    monkeypatch.setattr(config, "CONFIGS", tmp_path)
    monkeypatch.setenv("TMS_STATE", str(tmp_path / "state"))
    monkeypatch.delenv("ROS_DOMAIN_ID", raising=False)
    (tmp_path / "machines").mkdir()
    (tmp_path / "site.yaml").write_text(
        yaml.safe_dump({**site_data(51, 21000), "machines": {"zx": {"model": "zx200"}}})
    )

    def run(model: dict[str, Any]) -> Any:
        (tmp_path / "machines" / "zx200.yaml").write_text(yaml.safe_dump(model, sort_keys=False))
        return tms(check.command, "--site", str(tmp_path / "site.yaml"))

    return run


def test_a_site_whose_ground_is_wrong(checked: Callable[[dict[str, Any]], Any], tmp_path: Path) -> None:
    site = tmp_path / "site.yaml"
    site.write_text(site.read_text() + "ground: {area: [0, 0, 1]}\n")
    assert "ground.area" in str(checked(MODEL).exception)


def test_a_site_whose_trackers_are_wrong(checked: Callable[[dict[str, Any]], Any], tmp_path: Path) -> None:
    (tmp_path / "sensing.yaml").write_text("trackers: {eye: {kind: person, topic: eye}}")
    site = tmp_path / "site.yaml"
    site.write_text(site.read_text() + "sensing: sensing.yaml\n")
    found = checked(MODEL).exception
    assert found.reason.find(TrackersNeedAreas) is not None


def test_a_site_whose_hardware_is_wrong(checked: Callable[[dict[str, Any]], Any], tmp_path: Path) -> None:
    site = tmp_path / "site.yaml"
    given = yaml.safe_load(site.read_text())
    given["machines"]["zx"]["hardware"] = {"engine": {"topic": "rpm", "above": "fast"}}
    site.write_text(yaml.safe_dump(given))
    assert "machines.zx.hardware.engine.above" in str(checked(MODEL).exception)


def changed(change: Callable[[Any], object]) -> dict[str, Any]:
    model: dict[str, Any] = copy.deepcopy(MODEL)
    change(model)
    return model


def test_the_model_as_it_is(checked: Callable[[dict[str, Any]], Any]) -> None:
    assert checked(MODEL).exit_code == 0


@pytest.mark.parametrize(
    ("change", "key", "problem"),
    [
        (lambda m: m["response"].pop("boom_joint"), "response", NoResponse("boom_joint")),
        (lambda m: m["response"].pop("drive"), "response", NoResponse("drive")),
        (lambda m: m.pop("response"), "response", NoResponse("swing_joint")),
        (lambda m: m["response"].update(bucket_end_joint=m["response"]["drive"]),
         "response.bucket_end_joint", NoMover("bucket_end_joint")),
        (lambda m: m["response"]["boom_joint"].pop("dead_time"), "response.boom_joint.dead_time", MissingKey()),
        (lambda m: m["response"]["boom_joint"].update(dead_time=-0.1), "response.boom_joint.dead_time", "-0.1"),
        (lambda m: m["response"]["boom_joint"].update(lag=0), "response.boom_joint.lag", "0"),
        (lambda m: m["response"]["boom_joint"].update(origin=""), "response.boom_joint.origin", "''"),
        (lambda m: m["borders"]["sim"]["sources"].pop("odom"), "borders.sim.sources.odom", NoSourceFacts()),
        (lambda m: m["borders"]["sim"].pop("odom"), "borders.sim.sources.odom", NoTopic("odom")),
        (lambda m: m["borders"]["sim"].update(imu="imu"), "borders.sim.sources.imu", NoSourceFacts()),
        (lambda m: m["borders"]["sim"]["sources"]["odom"].pop("stamps"), "borders.sim.sources.odom.stamps",
         MissingKey()),
        (lambda m: m["borders"]["sim"]["sources"]["odom"].update(stamps="local"), "borders.sim.sources.odom.stamps",
         "'local'"),
        (lambda m: m["borders"]["sim"]["sources"]["odom"].update(period=0), "borders.sim.sources.odom.period", "0"),
        (lambda m: m["borders"]["physx"]["sources"]["pose"].update(message="Pose"),
         "borders.physx.sources.pose.message", "'Pose'"),
        (lambda m: m["borders"]["sim"]["sources"].update(lidar={"period": 1.0}), "borders.sim.sources.lidar.[key]",
         "'lidar'"),
        (lambda m: m.pop("still"), "still", MissingKey()),
        (lambda m: m["still"].pop("linear"), "still.linear", MissingKey()),
        (lambda m: m["still"].update(seconds=0), "still.seconds", "0"),
    ],
)  # fmt: skip
def test_what_a_machine_file_may_not_leave_open(
    checked: Callable[[dict[str, Any]], Any], tmp_path: Path, change: Callable[[Any], object], key: str,
    problem: Reason | str,
) -> None:  # fmt: skip
    found = checked(changed(change)).exception.reason
    first = found.problems[0] if isinstance(found, BadConfig) else found
    assert (first.file, first.key) == (str(tmp_path / "machines" / "zx200.yaml"), key)
    if isinstance(problem, str):  # what pydantic refuses, in its own words
        assert isinstance(first.problem, BadValueOf) and first.problem.value == problem
    else:
        assert first.problem == problem
