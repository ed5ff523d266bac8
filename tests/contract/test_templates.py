"""The templates of configs/: their form, the keys that known tasks give them, and those tasks with them."""

from pathlib import Path

import pytest

from tms_config.config import CONFIGS
from tms_reason import xml_text
from tms_ts import bt
from tms_ts.bt.check_template import check_template
from tms_ts.tree_reasons import KeyOpen, NoTemplate
from v6_templates import OURS, TASKS, known

GIVEN = {  # what tasks of the C++ system give to templates that are in none of its files that we have
    "Excavate_combined": {"excavate1", "excavate2", "excavate3"},
    "Release_combined": {"release1", "release2", "release3"},
    "Vessel_Release_Subtask": {"dump_up_angle", "dump_down_angle", "time"},
    "Cruise_Subtask_1_nav": {"start_status"},
    "Loading_Subtask": {
        "swing_angle_for_loading", "swing_angle_for_runing", "arrival_flg_record_name", "loaded_flg_record_name",
    },
}  # fmt: skip
ALWAYS = {"model_name", "machine_record_name", "terminate_condition"}


def test_there_is_one_for_each_name() -> None:
    assert OURS.keys() == GIVEN.keys()
    listed = (CONFIGS / "templates" / "README.md").read_text(encoding="utf-8")
    assert all(f"| `{name}` | " in listed for name in OURS)


@pytest.mark.parametrize("path", OURS.values(), ids=OURS)
def test_its_form_and_keys(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    xml_text.template_top(xml_text.elements(xml_text.decode(text), comments=False))
    report = check_template(path.stem, text, known)
    assert set(report.keys) <= GIVEN[path.stem] | ALWAYS
    assert set(report.keys) >= GIVEN[path.stem]
    assert "Made up by this project" in text
    listed = (CONFIGS / "templates" / "README.md").read_text(encoding="utf-8")
    row = next(line for line in listed.splitlines() if line.startswith(f"| `{path.stem}` "))
    assert all(key in row for key in report.keys)
    assert not report.warnings, "the C++ system takes it, too"


@pytest.mark.parametrize("path", OURS.values(), ids=OURS)
def test_its_nodes_and_ports(path: Path) -> None:
    assert [str(error) for error in check_template(path.stem, path.read_text(encoding="utf-8"), known).errors] == []


@pytest.mark.parametrize("path", sorted(TASKS.glob("*.xml")), ids=lambda path: path.stem)
def test_the_tasks_of_the_cpp_system_find_their_templates(path: Path) -> None:
    errors = bt.check(path.read_text(encoding="utf-8"), templates=known).errors
    assert [str(one) for one in errors if isinstance(one.what, NoTemplate)] == []
    if not path.stem.endswith("leveling_task"):  # which gives no values: there the words none stand in the tree
        assert [str(one) for one in errors if isinstance(one.what, KeyOpen)] == []
