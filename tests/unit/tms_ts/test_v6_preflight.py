"""Tasks of version 6 of the C++ system on a site with their machines and our records: the check before a run."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest
import yaml

from conftest import site_data
from tms_config.config import Site, load_site
from tms_machine.goal_inputs import Inputs
from tms_reason.reason import Reason
from tms_ts.bt import load
from tms_ts.preflight import StoredRecord, preflight
from tms_ts.surroundings import unfit
from v6_site import MACHINES, filled, records
from v6_templates import TASKS, known
from words import words

HEAD = ("model_name", "record_name", "type", "description", "max_age")
# A task that gives no values to the template that it calls, and one that gives the empty text for the names of records.
NOT_GIVEN = {"subtask__Bulldozer__leveling_task", "subtask__CrawlerDump__Load_and_Cruise_and_Release_Task"}
FILES = [path.stem for path in sorted(TASKS.glob("*.xml")) if path.stem not in NOT_GIVEN]


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Site:
    monkeypatch.delenv("ROS_DOMAIN_ID", raising=False)
    machines = {name: {"model": model} for name, model in MACHINES.items()}
    (tmp_path / "site.yaml").write_text(yaml.safe_dump(site_data(52, 22000, machines=machines)))
    return load_site(str(tmp_path / "site.yaml"))


class Around:
    """Machines that are well, and the records of configs/parameters."""

    def __init__(self, site: Site) -> None:
        self._site = site
        self._records = {
            (one.get("model_name", ""), one["record_name"]): StoredRecord(
                {name: value for name, value in one.items() if name not in HEAD}, one["type"], 0.0
            )
            for one in records()
        }

    def record(self, machine: str, record: str) -> StoredRecord | None:
        return self._records.get((machine, record))

    def names(self, machine: str) -> list[str]:
        return [record for of, record in self._records if of == machine]

    def misread(self, machine: str, subtask: str) -> Reason | None:
        return None

    def served(self, machine: str, subtask: str) -> bool:
        return False

    def problem(self, machine: str) -> Reason | None:
        return None

    def written(self, record: str, field: str) -> bool:
        return True

    def silent(self, machine: str, record: str) -> str:
        return ""

    def unfit(self, machine: str, subtask: str, values: Mapping[str, Any], inputs: Inputs) -> Reason | None:
        return unfit(self._site.model_of(machine), subtask, values, inputs)

    def oldest(self, machine: str, subtask: str) -> float:
        return 0.0

    def refusal(self, machine: str, subtask: str, record: str, inputs: Inputs) -> None:
        return None

    def unplanned(self) -> list[Reason]:
        return []


def errors(file: str, site: Site) -> list[str]:
    tree = load(filled(file), world=None, templates=known)
    return [words(reason) for reason in preflight(tree, site, Around(site)).errors]


@pytest.mark.parametrize("file", FILES)
def test_the_check_before_a_run_finds_no_error(file: str, site: Site) -> None:
    assert errors(file, site) == []


def test_a_record_name_that_is_empty_is_told(site: Site) -> None:
    found = errors("subtask__CrawlerDump__Load_and_Cruise_and_Release_Task", site)
    assert found and all("mst110cr/" in text for text in found)
