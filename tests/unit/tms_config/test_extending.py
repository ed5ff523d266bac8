"""Borders that extend another one, and YAML's own way to repeat a mapping."""

from pathlib import Path
from typing import Any

import pytest
import yaml

from conftest import PROJECT
from tms_config.extending import extended
from tms_config.models import MachineModel
from tms_config.reasons import BadKey, BadLine, ExtendsItself, ExtendsNothing, NoMerge
from tms_config.yaml_file import parse, read_yaml
from tms_reason.errors import ConfigError

SIM = {"odom": "odom", "emg_stop": "emg_stop", "sources": {"odom": {"period": 0.1, "stamps": "utc"}}}


def border(**own: Any) -> Any:
    return extended({"sim": SIM, "opera": {"extends": "sim", **own}})["opera"]


def test_it_has_what_it_extends() -> None:
    assert border() == SIM


def test_its_own_keys_win_and_null_takes_away() -> None:
    assert border(odom="odom_pose", emg_stop=None) == {"odom": "odom_pose", "sources": SIM["sources"]}


def test_sources_are_merged_by_name_and_never_inside() -> None:
    found = border(sources={"odom": {"period": 0.2}, "imu": {"period": 0.01}})["sources"]
    assert found == {"odom": {"period": 0.2}, "imu": {"period": 0.01}}
    assert border(sources={"imu": {"period": 0.01}})["sources"]["odom"] == {"period": 0.1, "stamps": "utc"}


def test_a_border_may_extend_one_that_extends() -> None:
    found = extended({"sim": SIM, "opera": {"extends": "sim", "odom": "b"}, "physx": {"extends": "opera"}})
    assert found["physx"] == {**SIM, "odom": "b"}


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"opera": {"extends": "unity"}}, ExtendsNothing("unity", ("opera", "physx", "sim"))),
        ({"opera": {"extends": ["sim"]}}, ExtendsNothing("['sim']", ("opera", "physx", "sim"))),
        ({"opera": {"extends": "opera"}}, ExtendsItself("opera")),
        ({"opera": {"extends": "physx"}, "physx": {"extends": "opera"}}, ExtendsItself("physx")),
    ],
)
def test_what_cannot_be_extended_is_refused_with_its_line(tmp_path: Path, change: Any, reason: Any) -> None:
    data = yaml.safe_load((PROJECT / "configs" / "machines" / "zx200.yaml").read_text(encoding="utf-8"))
    data["borders"].update(change)
    file = tmp_path / "x.yaml"
    file.write_text(yaml.safe_dump(data))
    with pytest.raises(ConfigError) as caught:
        parse(file, MachineModel)
    found = caught.value.reason
    assert isinstance(found, BadKey) and found.problem == reason
    assert "extends" in file.read_text().splitlines()[found.line - 1]


def test_yaml_merges(tmp_path: Path) -> None:
    file = tmp_path / "x.yaml"
    file.write_text("a: &a {x: 1, y: 2}\nb: &b {y: 3, z: 4}\nc: {<<: *a, y: 5}\nd: {y: 6, <<: [*a, *b]}\n")
    found = read_yaml(file)
    assert found["c"] == {"x": 1, "y": 5}
    assert found["d"] == {"x": 1, "y": 6, "z": 4}


@pytest.mark.parametrize("text", ["a: 1\nb: {<<: 3}\n", "a: &a [1]\nb: {<<: *a}\n"])
def test_what_is_no_mapping_cannot_be_merged(tmp_path: Path, text: str) -> None:
    file = tmp_path / "x.yaml"
    file.write_text(text)
    with pytest.raises(ConfigError) as caught:
        read_yaml(file)
    assert caught.value.reason == BadLine(str(file), 2, NoMerge())
