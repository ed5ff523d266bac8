"""`tms check` says what is wrong in a machine file, where, and why it matters."""

import copy
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml

from conftest import site_data
from tms_cli.commands import check
from tms_config import config

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


def changed(change: Callable[[Any], object]) -> dict[str, Any]:
    model: dict[str, Any] = copy.deepcopy(MODEL)
    change(model)
    return model


def test_the_model_as_it_is(checked: Callable[[dict[str, Any]], Any]) -> None:
    assert checked(MODEL).exit_code == 0


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda m: m["response"].pop("boom_joint"),
         "response: no dead time and lag for boom_joint, which moves: no stop could be proven"),
        (lambda m: m["response"].pop("drive"),
         "response: no dead time and lag for drive, which moves: no stop could be proven"),
        (lambda m: m.pop("response"), "response: no dead time and lag for swing_joint"),
        (lambda m: m["response"].update(bucket_end_joint=m["response"]["drive"]),
         "response: bucket_end_joint is no joint that moves, nor 'drive'"),
        (lambda m: m["response"]["boom_joint"].pop("dead_time"), "response.boom_joint.dead_time: Field required"),
        (lambda m: m["response"]["boom_joint"].update(dead_time=-0.1), "response.boom_joint.dead_time: "),
        (lambda m: m["response"]["boom_joint"].update(lag=0), "response.boom_joint.lag: "),
        (lambda m: m["response"]["boom_joint"].update(origin=""), "response.boom_joint.origin: "),
        (lambda m: m["borders"]["sim"]["sources"].pop("odom"),
         "borders.sim: odom: sources.odom is missing: say its period, stamps and frozen_after"),
        (lambda m: m["borders"]["sim"].pop("odom"), "borders.sim: sources.odom: the border has no topic 'odom'"),
        (lambda m: m["borders"]["sim"].update(imu="imu"), "borders.sim: imu: sources.imu is missing"),
        (lambda m: m["borders"]["sim"]["sources"]["odom"].pop("stamps"), "borders.sim.sources.odom.stamps: "),
        (lambda m: m["borders"]["sim"]["sources"]["odom"].update(stamps="local"), "borders.sim.sources.odom.stamps: "),
        (lambda m: m["borders"]["sim"]["sources"]["odom"].update(period=0), "borders.sim.sources.odom.period: "),
        (lambda m: m["borders"]["physx"]["sources"]["pose"].update(message="Pose"),
         "borders.physx.sources.pose.message: "),
        (lambda m: m["borders"]["sim"]["sources"].update(lidar={"period": 1.0}), "borders.sim.sources.lidar"),
        (lambda m: m.pop("still"), "still: Field required"),
        (lambda m: m["still"].pop("linear"), "still.linear: Field required"),
        (lambda m: m["still"].update(seconds=0), "still.seconds: "),
    ],
)  # fmt: skip
def test_what_a_machine_file_may_not_leave_open(
    checked: Callable[[dict[str, Any]], Any], tmp_path: Path, change: Callable[[Any], object], said: str
) -> None:
    told = str(checked(changed(change)).exception)
    assert told.startswith(str(tmp_path / "machines" / "zx200.yaml")), told
    assert said in told
