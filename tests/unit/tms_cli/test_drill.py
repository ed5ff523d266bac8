"""What the drill tries, with what, and how it counts."""

import json
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from tms_cli.commands import drill
from tms_cli.drill import tasks
from tms_cli.drill.figures import percentile, summary
from tms_cli.drill.plan import FAULTS, NONE, OPERASIM, RP, SINGLE, STAND_INS, fault_of, plan, plan_only
from tms_cli.drill.report import line, markdown, text
from tms_cli.drill.verdict import HUNG, LEFT_OUT, Row
from tms_config.config import CONFIGS, load_site
from tms_config.site_file import Fault
from tms_subtasks.records.waypoints import Waypoint
from tms_ts import bt

MACHINES = {"zx200": True, "zx120": True, "ic120_1": False, "mst2200_1": False, "mst110cr_2": False, "d37": False}
SITE = str(CONFIGS / "sites" / "drill.yaml")
EVERY_STOP = set(STAND_INS.stops.values())
OPERASIM_MACHINES = {"zx200": True, "zx120": True, "ic120": False, "mst110cr": False}


@pytest.mark.parametrize("seed", range(20))
def test_a_quick_drill_has_every_stop_and_every_fault(seed: int) -> None:
    waves = plan(seed, MACHINES, 1, quick=True)
    trials = [trial for wave in waves for trial in wave]
    assert {trial.stop for trial in trials} == EVERY_STOP
    assert {trial.fault for trial in trials} == set(FAULTS)
    assert len(waves) == 12


@pytest.mark.parametrize("seed", range(20))
def test_a_quick_drill_over_operasim_has_every_stop_of_it_and_no_fault(seed: int) -> None:
    trials = [trial for wave in plan(seed, OPERASIM_MACHINES, 1, quick=True, kinds=OPERASIM) for trial in wave]
    assert {trial.stop for trial in trials} == set(OPERASIM.stops.values())
    assert {"kill mc", "freeze tms:if", "connection of the simulator lost"} <= set(OPERASIM.stops)
    assert {trial.fault for trial in trials} == {NONE}


def test_a_stop_that_a_site_does_not_know_is_refused(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("TMS_STATE", str(tmp_path / "state"))
    monkeypatch.setenv("TMS_SITE", SITE)
    refused = CliRunner().invoke(drill.command, ["--only", "simulator paused"])
    assert refused.exit_code == 2
    assert "this site cannot be drilled with 'simulator paused': cancel, " in refused.output


def test_four_rounds_have_every_stop_with_every_fault() -> None:
    waves = plan(7, MACHINES, 4, quick=False)
    trials = [trial for wave in waves for trial in wave]
    assert len(trials) >= 600
    tried = {(trial.stop, trial.fault) for trial in trials}
    assert {(stop, fault) for stop in SINGLE for fault in FAULTS if RP not in stop.processes} <= tried


def test_only_trials_of_one_machine_alone_begin_each_for_itself() -> None:
    assert {stop for stop in EVERY_STOP if stop.own} == set(SINGLE)


def test_a_plan_can_be_repeated() -> None:
    assert plan(3, MACHINES, 2, quick=False) == plan(3, MACHINES, 2, quick=False)
    assert plan(3, MACHINES, 2, quick=False) != plan(4, MACHINES, 2, quick=False)


@pytest.mark.parametrize("quick", [True, False])
def test_a_wave_has_one_trial_a_machine_and_hits_all_at_once_or_none(quick: bool) -> None:
    for wave in plan(1, MACHINES, 1, quick):
        assert [trial.machine for trial in wave] == list(MACHINES)
        assert len({trial.stop for trial in wave if trial.stop.shared}) in (0, 1)
        assert len({trial.stop.shared for trial in wave}) == 1
        assert all(MACHINES[t.machine] for t in wave if not t.stop.shared and RP in t.stop.processes)


def test_the_plan_fits_a_site_of_one_machine() -> None:
    assert all(len(wave) == 1 for wave in plan(1, {"ic120": False}, 1, quick=True))


@pytest.mark.parametrize("name", STAND_INS.stops)
def test_a_drill_of_one_stop_hits_every_machine_with_it(name: str) -> None:
    waves = plan_only(2, MACHINES, name, 9)
    assert [[trial.machine for trial in wave] for wave in waves] == [list(MACHINES)] * 9
    for trial in (trial for wave in waves for trial in wave):
        lacks_it = STAND_INS.stops[name].processes == (RP,) and not MACHINES[trial.machine]
        assert trial.stop == (SINGLE[0] if lacks_it else STAND_INS.stops[name])


def test_a_quick_drill_of_one_stop_is_refused() -> None:
    refused = CliRunner().invoke(drill.command, ["--quick", "--only", "cancel"])
    assert refused.exit_code == 2
    assert "--quick and --only exclude each other" in refused.output


@pytest.mark.parametrize("name", FAULTS)
def test_a_stand_in_takes_each_fault(name: str) -> None:
    fault = Fault.model_validate_json(json.dumps(fault_of(name, ["swing_joint", "boom_joint"])))
    assert (fault == Fault()) == (name == NONE)
    assert fault.mute == (("swing_joint",) if "mute" in name else ())


@pytest.mark.parametrize("machine", load_site(SITE).file.machines)
def test_each_machine_has_an_endless_task_of_its_own(machine: str) -> None:
    site = load_site(SITE)
    tree, records = tasks.task(site, machine)
    goals = bt.load(tree).leaf_goals()
    assert {goal.machine for goal in goals} == {machine} and len(goals) >= 2
    assert {goal.record for goal in goals} == set(records)
    assert {goal.subtask for goal in goals} <= set(site.model_of(machine).subtasks)
    assert 'num_cycles="-1"' in tree
    primitives = {"zx200", "mst2200", "mst110cr", "d37pxi"}  # models that have them: leaves of version 6
    assert all(goal.subtask.startswith("primitive_") for goal in goals) == (
        site.file.machines[machine].model in primitives
    )


def test_an_excavator_of_version_6_moves_along_plans_that_rest_in_records() -> None:
    tree, records = tasks.task(load_site(SITE), "zx200")
    asked = [
        (goal.subtask.removeprefix("primitive_excavator_change_pose_"), goal.record)
        for goal in bt.load(tree).leaf_goals()
    ]
    assert asked == [(what, record) for record in records for what in ("plan", "execute_from_plan")]
    for values in records.values():
        Waypoint.model_validate(values)


def test_percentiles() -> None:
    assert percentile([], 0.99) is None
    assert percentile([3.0, 1.0, 2.0], 0.5) == 2.0
    assert percentile([float(n) for n in range(1, 101)], 0.99) == 99.0


def row(**changes: Any) -> Row:
    values: dict[str, Any] = {
        "machine": "zx200", "model": "zx200", "stop": "kill rc", "how": "kill", "fault": NONE, "fault_at": 0.1,
        "in_order": True, "reported_s": 0.5, "stood_s": 2.0, "travel_joint": "swing_joint",
        "travel_rad": 0.25, "back_s": 3.0, "outcome": "goes on", "confirmed": True,
    }  # fmt: skip
    return Row(**{**values, **changes})


def test_the_summary_counts_what_matters() -> None:
    rows = [
        row(), row(reported_s=0.9, stood_s=4.0, travel_rad=0.75),
        row(fault="coast", in_order=False, stood_s=8.0, reported_s=None, unconfirmed=True, confirmed=False),
        row(stop="kill rc+tms:ts", unconfirmed=True, unlatched=True), row(unconfirmed=True, ran_on=True, stood_s=None),
        row(how="cancel", stop="cancel", reported_s=None, false_receipt="moved"), row(outcome=HUNG, disturbed=True),
        row(back_s=None), row(outcome=LEFT_OUT, back_s=None),
        row(void="its motion ended by itself", unconfirmed=True, back_s=None),
    ]  # fmt: skip
    found = summary(rows, 7)
    counted = {name: found[name] for name in drill.drill_figures.BAD}
    assert counted == {
        "false_receipts": 1, "hung": 1, "ran_on": 1, "unlatched": 1, "disturbed": 1, "not_back": 1, "left_out": 1,
    }  # fmt: skip
    assert (found["seed"], found["trials"], found["kills"], found["void"]) == (7, 8, 7, 1)
    assert (found["unconfirmed"], found["unconfirmed_in_order"]) == (3, 1)
    assert (found["kill_to_stop_max_s"], found["stop_p50_s"], found["stop_p99_s"]) == (0.9, 2.0, 4.0)
    kill = next(one for one in found["stops"] if one["stop"] == "kill")
    assert (kill["stood_max_s"], kill["joint"], kill["travel_max_rad"]) == (4.0, "swing_joint", 0.75)
    json.dumps(found, allow_nan=False)


def test_what_is_told_of_it() -> None:
    rows = [row(receipts=["+0.50 s, after 2.00 s confirmed (a|b)"]), row(false_receipt="moved 0.10 s after")]
    found = summary(rows, 7)
    page = markdown(rows, found, "drill")
    assert "停止訓練" in page and "| zx200 | kill rc | none | 0.500 | 2.000 |" in page and "(a/b)" in page
    told = text(found, rows)
    assert "Confirmed, and truly moving: 1" in told
    assert "FALSE RECEIPT: moved 0.10 s after" in line(rows[1])
    last = told.splitlines()[-1]
    assert last.startswith("WRONG: Confirmed, and truly moving: zx200: kill rc, none") and told.count("WRONG") == 1


@pytest.fixture
def ready(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """A site of which nothing runs, with a state folder of its own."""
    monkeypatch.setenv("TMS_STATE", str(tmp_path / "state"))
    return tmp_path


@pytest.mark.parametrize(("back", "code"), [(2.0, 0), (None, 1)])
def test_the_exit_code_tells_of_it(
    ready: Path, tms: Any, monkeypatch: pytest.MonkeyPatch, back: float | None, code: int
) -> None:
    monkeypatch.setattr(drill, "drill", lambda *_: [row(back_s=back)])
    end = tms(drill.command, "--seed", 7, "--report", ready / "drill.md")
    assert end.exit_code == code
    assert f"Processes that did not come back: {code}" in end.stdout and "Seed: 7" in end.stdout
    assert "停止訓練" in (ready / "drill.md").read_text(encoding="utf-8")


def test_it_has_a_state_folder_of_its_own_that_is_new(ready: Path, tms: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    old = ready / "state" / "drill" / "rc" / "zx200.armed"
    old.parent.mkdir(parents=True)
    old.touch()
    found: list[Path] = []
    monkeypatch.setattr(drill, "drill", lambda site, *_: found.append(site.state) or [row()])
    assert tms(drill.command, "--json").exit_code == 0
    assert found == [ready / "state" / "drill"] and not old.exists()


def test_a_report_that_cannot_be_written_is_told_before_anything_is_killed(
    ready: Path, tms: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(drill, "drill", lambda *_: pytest.fail("it began"))
    end = tms(drill.command, "--report", ready / "out" / "drill.md")
    assert "drill.md cannot be written" in str(end.exception)


@pytest.mark.parametrize(
    ("change", "reported"),
    [
        ("backend: opera", "Choose a site with backend 'sim'"),
        ("pcs: {cps: {address: 127.0.0.1}}", "and no pcs:"),
        ("machines: {}", "at least one machine"),
    ],
)
def test_a_site_that_must_not_be_drilled(
    ready: Path, tms: Any, monkeypatch: pytest.MonkeyPatch, change: str, reported: str
) -> None:
    path = ready / "site.yaml"
    path.write_text(f"name: t\ndomain: 1\nservices: {{db: {{}}}}\n{change}\n")
    monkeypatch.setattr(drill.session, "site", lambda: load_site(str(path)))
    end = tms(drill.command)
    assert reported in str(end.exception) and not (ready / "state" / "drill").exists()
