"""Records from outside are checked: each refusal names the file, the record and the field."""

from pathlib import Path
from typing import Any

import pytest

from tms_config.config import CONFIGS
from tms_db import records
from tms_db.parameters import RecordEdit
from tms_reason.errors import ConfigError, DbError

LOADING = {
    "initial_pose", "target_excavate_pose", "hold_soil_while_elevating_pose", "hold_soil_while_turning_pose",
    "target_release_pose", "release_pose", "release_angle", "after_release_soil_pose", "pending_pose", "finish_pose",
}  # fmt: skip


def read(tmp_path: Path, text: str) -> list[records.Record]:
    (tmp_path / "r.yaml").write_text(text)
    return records.read_file(tmp_path / "r.yaml")


@pytest.mark.parametrize(
    ("values", "says"),
    [
        ({"": 1}, "no name"),
        ({1: 1}, "no text"),
        ({"source": "x"}, "'source' is reserved"),
        ({"timestamps": 1}, "'timestamps' is reserved"),
        ({"$set": 1}, "must not start with [$]"),
        ({"a.b": 1}, "dots"),
        ({"a\0": 1}, r"holds the control character U\+0000"),
        ({"x": float("nan")}, "p.x: nan is not a finite number"),
        ({"x": [1.0, float("inf")]}, "p.x: inf is not a finite number"),
        ({"x": 2**63}, "does not fit into 64 bits"),
        ({"x": None}, "p.x: an empty value cannot be stored"),
        ({"x": {"y": None}}, "an empty value cannot be stored"),
        ({"x": {"$y": 1}}, "must not start with [$]"),
        ({"x": [{"y": 1}, 2]}, "mixes types"),
        ({"x": [[1]]}, "a nested array cannot be stored"),
        ({"x": b"1"}, "a bytes cannot be stored"),
        ({"x": ["a", 1]}, "mixes types"),
        ({"x": [True, 1]}, "mixes types"),
        ({"x": "a\0b"}, "NUL"),
    ],
)
def test_values_that_are_refused(values: dict[Any, Any], says: str) -> None:
    with pytest.raises(DbError, match=says) as caught:
        records.check_values("zx200/p", values)
    assert caught.value.code == "BAD_RECORD"
    assert str(caught.value).startswith("zx200/p")


def test_values_that_are_taken() -> None:
    records.check_values(
        "r",
        {
            "o": {"a": [{"b": [1, 2.5]}], "c": [[1], [2]]},
            "os": [{"a": 1}, {}],
            "i": -(2**63),
            "d": 1e300,
            "b": True,
            "s": "",
            "a": [],
            "m": [1, 2.5],
            "LOCK_FLG": False,
        },
    )


@pytest.mark.parametrize(
    ("key", "says"),
    [
        (("zx200", ""), "record_name is empty"),
        (("zx200", " "), "record_name ' ' is empty"),
        ((" zx200", "p"), "model_name ' zx200' begins or ends with a blank"),
        (("zx200", "p\n"), r"record_name 'p\\n' holds the control character U\+000A; Write a plain name"),
        (("zx200", "ev\0il"), r"record_name 'ev\\x00il' holds the control character U\+0000; Write a plain name"),
        (("z\x1b", "p"), r"model_name 'z\\x1b' holds the control character U\+001B"),
        (("z" * 201, "p"), "model_name 'z+' has more than 200 letters"),
    ],
)
def test_keys_that_are_refused(key: tuple[str, str], says: str) -> None:
    with pytest.raises(DbError, match=says):
        records.check_key(*key)


@pytest.mark.parametrize("key", ["description", "source"])
def test_a_line_about_a_record_holds_no_control_characters(key: str) -> None:
    with pytest.raises(
        DbError, match=rf"^zx200/p: {key} holds the control character U\+000A: remove it; Write a plain name$"
    ):
        RecordEdit({"a": 1}, **{key: "two\nlines"}).check("zx200/p")


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "must hold a list of records"),
        ("a: 1", "must hold a list of records"),
        ("- 3", "record 1: must hold keys and values"),
        ("- {record_name: p}", r"record 1 \(/p\): type is ''"),
        ("- {record_name: p, type: fixed}", "type is 'fixed': write static or dynamic"),
        ("- {model_name: zx200, type: static}", "record 1: record_name is empty"),
        ("- {record_name: 3, type: static}", "record_name is 3, not text"),
        ('- {record_name: "ev\\0il", type: static}', r"record 1: record_name 'ev\\x00il' holds the control character"),
        (
            '- {record_name: p, type: static, description: "a\\0b"}',
            r"\(/p\): description holds the control",
        ),
        ('- {record_name: p, type: static, "a\\0b": 1}', r"field name 'a\\x00b' holds the control character U\+0000"),
        ("- {record_name: p, type: static, x: 1e3}", "write it with a dot"),
        ("- {record_name: p, type: static, x: 2024-01-01}", "a date cannot be stored"),
        ("- {record_name: p, type: static, x: .nan}", "x: nan is not a finite number"),
        ("- {record_name: p, type: static, x: }", "x: an empty value"),
        ("- {record_name: p, type: static}\n- {record_name: p, type: dynamic}", "/p is there twice"),
    ],
)
def test_files_that_are_refused(tmp_path: Path, text: str, says: str) -> None:
    with pytest.raises(DbError, match=says) as caught:
        read(tmp_path, text)
    assert str(caught.value).startswith(f"{tmp_path}/r.yaml")


def test_file_that_is_no_yaml(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"r\.yaml:2:"):
        read(tmp_path, "- {record_name: p,\n  : :")
    with pytest.raises(ConfigError, match="key 'x' is there twice"):
        read(tmp_path, "- {record_name: p, type: static, x: 1, x: 2}")
    for key in ("{{ ip }}", "{[a]: 1}"):
        with pytest.raises(ConfigError, match=r"r\.yaml:2: a key is itself a mapping or a list"):
            read(tmp_path, f"- record_name: p\n  x: {key}")
    with pytest.raises(ConfigError, match="cannot be read"):
        records.read_file(tmp_path / "none.yaml")


def test_types_of_yaml_values_are_kept(tmp_path: Path) -> None:
    (record,) = read(tmp_path, "- {record_name: p, type: dynamic, i: 1, d: 1.0, b: true, s: '4', a: [1, 2]}")
    assert record.model_name == ""
    assert {name: type(value) for name, value in record.values.items()} == {
        "i": int, "d": float, "b": bool, "s": str, "a": list,
    }  # fmt: skip


def test_zx200_records_of_the_loading_cycles() -> None:
    found = {record.record_name: record for record in records.read_file(CONFIGS / "parameters" / "zx200.yaml")}
    assert set(found) >= LOADING
    assert all(record.model_name == "zx200" and record.description for record in found.values())
    assert found["release_angle"].values == {"target_angle": -0.34}
    assert found["target_excavate_pose"].type == "dynamic"
