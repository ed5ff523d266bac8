"""`tms param`: typed values, keys, loading of files, shapes of --json."""

import json
from pathlib import Path
from typing import Any

import pytest
import yaml
from tms_msg_db.msg import Record
from tms_msg_db.srv import GetParameter, ListParameters, SetParameter

from tms_cli import record_words, stored_records
from tms_cli.commands import param
from tms_machine.values import from_parameters, to_parameters
from tms_reason.errors import DbError, TmsError
from tms_reason.reason import Foreign


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1.5", 1.5), ("3", 3), ("+3", 3), ("-5", -5), ("-.5", -0.5), ("1.", 1.0), ("1e3", 1000.0), ("-1E-3", -0.001),
        ("true", True), ("False", False), ("text", "text"), ("'text'", "text"), ("'5'", "5"), ("''", ""),
        ("[1,2,3]", [1, 2, 3]), ("[1, 2.5]", [1, 2.5]), ("[]", []), ("[a, 'b c']", ["a", "b c"]), ("日本", "日本"),
        ("010", 10), ("yes", "yes"), ("1:30", "1:30"), ("2024-01-01", "2024-01-01"), ("1_000", "1_000"),
    ],
)  # fmt: skip
def test_values_keep_the_type_that_was_written(text: str, value: Any) -> None:
    parsed = record_words.parse_value(text)
    assert parsed == value
    assert type(parsed) is type(value)


@pytest.mark.parametrize("text", ["nan", "NaN", ".nan", "inf", "-inf", "Infinity", "", "null", "~", "# x", "[", "@x"])
def test_what_is_no_value_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match=r"number|empty|quotes"):
        record_words.parse_value(text)


@pytest.mark.parametrize(
    ("word", "says"),
    [
        ("angle=1e999", "angle: inf is not a finite number"),
        ("angle={a: null}", "an empty value"),
        ("angle=[1, true]", "mixes types"),
        ("angle=99999999999999999999", "64 bits"),
        ("type=5", "'type' is reserved"),
        ("a.b=5", "must not"),
        ("angle=nan", "record m/r, field angle: nan"),
    ],
)
def test_fields_that_cannot_be_stored_are_named(word: str, says: str) -> None:
    with pytest.raises(TmsError, match=says) as caught:
        record_words.parse_fields("record m/r", [word])
    assert "\n" not in str(caught.value)


def test_yaml_elsewhere_is_not_changed_by_the_own_rules() -> None:
    assert yaml.safe_load("yes") is True


def test_reading_the_rules_does_not_execute_tags() -> None:
    with pytest.raises(ValueError, match="cannot be read"):
        record_words.parse_value("!!python/object/apply:os.system [id]")


def record(model: str, name: str, values: dict[str, Any], type_: str = "static") -> Record:
    return Record(model_name=model, record_name=name, type=type_, values=to_parameters(values), source="test")


def test_set_sends_typed_fields_and_says_who(mesh, tms) -> None:
    mesh.answers["/tms/db/set_parameter"] = SetParameter.Response(created=True)
    end = tms(param.command, "set", "zx200/a", "x=1", "y=2.0", "ok=true", "--create", "--type", "static", "--json")
    assert end.exit_code == 0, end.output
    assert json.loads(end.stdout)["created"] is True
    name, sent = mesh.asked[0]
    assert (name, sent["model_name"], sent["record_name"], sent["create"]) == (
        "/tms/db/set_parameter", "zx200", "a", True,
    )  # fmt: skip
    values = from_parameters(sent["values"])
    assert values == {"x": 1, "y": 2.0, "ok": True}
    assert [type(value) for value in values.values()] == [int, float, bool]
    assert sent["source"].startswith("cli")


@pytest.mark.parametrize(
    "words",
    [
        ["set", "zx200/a"],
        ["set", "zx200/a", "x"],
        ["set", "zx200/a", "=1"],
        ["set", "zx200/a", "x=1", "x=2"],
        ["set", "zx200", "x=1"],
        ["set", "zx200/", "x=1"],
        ["set", "zx200/a", "x=1", "--type", "other"],
        ["get", "a"],
    ],
)
def test_wrong_usage_is_exit_code_2(mesh, tms, words: list[str]) -> None:
    assert tms(param.command, *words).exit_code == 2
    assert not mesh.asked


def test_a_record_without_model_is_written_with_a_slash(mesh, tms) -> None:
    mesh.answers["/tms/db/get_parameter"] = GetParameter.Response(record=record("", "FLG", {"value": False}))
    end = tms(param.command, "get", "/FLG")
    assert mesh.asked[0][1] == {"model_name": "", "record_name": "FLG", "max_age": -1.0}
    assert "/FLG: static" in end.stdout
    assert "true/false" in end.stdout


def test_a_missing_record_is_one_error(mesh, tms) -> None:
    mesh.answers["/tms/db/get_parameter"] = DbError(Foreign("there is no record zx200/a"), "RECORD_MISSING")
    assert isinstance(tms(param.command, "get", "zx200/a").exception, DbError)


FILE = """
- {model_name: zx200, record_name: same, type: static, a: 1.0}
- {model_name: zx200, record_name: other_type, type: static, a: 1}
- {model_name: zx200, record_name: new, type: dynamic, b: true}
"""


def test_load_leaves_alone_what_says_the_same(mesh, tms, tmp_path: Path) -> None:
    (tmp_path / "r.yaml").write_text(FILE)
    there = [record("zx200", "same", {"a": 1.0, "more": 2}), record("zx200", "other_type", {"a": 1.0})]
    mesh.answers["/tms/db/list_parameters"] = ListParameters.Response(records=there)
    mesh.answers["/tms/db/set_parameter"] = lambda **fields: SetParameter.Response(
        created=fields["record_name"] == "new"
    )
    end = tms(param.command, "load", tmp_path / "r.yaml", "--json")
    assert json.loads(end.stdout) == {
        "created": ["zx200/new"], "changed": ["zx200/other_type"], "unchanged": ["zx200/same"],
    }  # fmt: skip


def test_a_bad_file_writes_nothing(mesh, tms, tmp_path: Path) -> None:
    (tmp_path / "r.yaml").write_text(FILE + "- {model_name: zx200, record_name: last, type: static, a: .nan}\n")
    end = tms(param.command, "load", tmp_path / "r.yaml")
    assert "(zx200/last).a: nan" in str(end.exception)
    assert not mesh.asked


def test_a_load_that_is_refused_says_how_far_it_got(mesh, tms, tmp_path: Path) -> None:
    (tmp_path / "r.yaml").write_text(FILE)
    mesh.answers["/tms/db/list_parameters"] = ListParameters.Response()
    mesh.answers["/tms/db/set_parameter"] = lambda **fields: (
        DbError(Foreign("in use"), "STATIC_RECORD")
        if fields["record_name"] == "other_type"
        else SetParameter.Response(created=True)
    )
    assert str(tms(param.command, "load", tmp_path / "r.yaml").exception) == (
        "in use (before that: 1 created, 0 changed, 0 unchanged)"
    )


@pytest.mark.parametrize(("patience", "code"), [(60.0, 0), (-1.0, 1)])
def test_a_load_waits_for_a_store_that_is_away(mesh, tms, tmp_path, monkeypatch, patience: float, code: int) -> None:
    monkeypatch.setattr(stored_records, "PATIENCE", patience)
    monkeypatch.setattr(stored_records, "PAUSE", 0.0)
    away = [DbError(Foreign("away"), "STORE_DOWN")] * 3

    def answer(**_: Any) -> SetParameter.Response | TmsError:
        return away.pop() if away else SetParameter.Response(created=True)

    mesh.answers["/tms/db/list_parameters"] = ListParameters.Response()
    mesh.answers["/tms/db/set_parameter"] = answer
    (tmp_path / "r.yaml").write_text(FILE)
    end = tms(param.command, "load", tmp_path / "r.yaml", "--json")
    assert end.exit_code == code
    if not code:
        assert json.loads(end.stdout)["created"] == ["zx200/same", "zx200/other_type", "zx200/new"]


def test_export_can_be_loaded_again(mesh, tms, tmp_path: Path) -> None:
    from tms_db.records import read_file

    values = {"x": -1.5, "tiny": 1e-7, "n": 3, "ok": True, "text": "yes", "list": [1.0, 2.0]}
    mesh.answers["/tms/db/list_parameters"] = ListParameters.Response(records=[record("zx200", "a", values)])
    (tmp_path / "r.yaml").write_text(tms(param.command, "export").stdout)
    (again,) = read_file(tmp_path / "r.yaml")
    assert again.values == values
    assert [type(value) for value in again.values.values()] == [type(value) for value in values.values()]


def test_list_for_machines_has_types_and_age(mesh, tms) -> None:
    mesh.answers["/tms/db/list_parameters"] = ListParameters.Response(records=[record("zx200", "a", {"x": 1})])
    (one,) = json.loads(tms(param.command, "list", "--json").stdout)
    assert one == {
        "model_name": "zx200", "record_name": "a", "type": "static", "description": "", "source": "test",
        "max_age": None, "updated_at": None, "age": None, "values": {"x": 1},
    }  # fmt: skip
