"""HoldPlace and FreePlace in trees, and what is found of them before a run."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from conftest import site_data
from tms_config.config import Site, load_site
from tms_config.reasons import NoMachine
from tms_places.reasons import HoldsAndTakes, MayWaitInCircle, NoPlace, WaitsForLease
from tms_ts.bt import FAILURE, RUNNING, SUCCESS
from tms_ts.place_check import check_places, orders_of
from tms_ts.preflight import at
from tms_ts.tree_reasons import NameMissing
from unit.tms_ts.fakes import FakePlaces, FakeWorld
from unit.tms_ts.trees import ticked, tree

WAITS = WaitsForLease("zx200", "road")


def hold(place: str, machine: str = "zx200") -> str:
    return f'<HoldPlace place="{place}" model_name="{machine}"/>'


def free(place: str, machine: str = "zx200") -> str:
    return f'<FreePlace place="{place}" model_name="{machine}"/>'


def test_a_hold_waits_until_the_machine_has_the_place() -> None:
    fake = FakeWorld(places=FakePlaces(WAITS))
    one = tree(hold("road"), fake=fake)
    assert ticked(one) == (RUNNING, WAITS)
    assert one.tick() is RUNNING
    fake.places.why = None
    assert one.tick() is SUCCESS
    assert fake.places.calls == [("hold", "zx200", "road")]
    one.halt()
    assert len(fake.places.calls) == 1, "what it holds stays"


def test_a_hold_that_is_halted_wants_the_place_no_more() -> None:
    fake = FakeWorld(places=FakePlaces(WAITS))
    one = tree(hold("road"), fake=fake)
    one.tick()
    one.halt()
    one.halt()
    assert fake.places.calls == [("hold", "zx200", "road"), ("free", "zx200", "road")]


def test_a_refusal_fails_the_node() -> None:
    fake = FakeWorld(places=FakePlaces(refusal=NoPlace("road", ())))
    assert ticked(tree(hold("road"), fake=fake)) == (FAILURE, NoPlace("road", ()))


def test_a_free_does_not_wait() -> None:
    fake = FakeWorld(places=FakePlaces(WAITS))
    assert tree(free("road"), fake=fake).tick() is SUCCESS
    assert fake.places.calls == [("free", "zx200", "road")]


def test_a_place_without_a_name_is_a_fault() -> None:
    (fault,) = tree(hold("")).faults
    assert fault.reason.find(NameMissing) == NameMissing("HoldPlace", "place")


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Site:
    monkeypatch.delenv("ROS_DOMAIN_ID", raising=False)
    file = tmp_path / "site.yaml"
    file.write_text(yaml.safe_dump(site_data(52, 22000)))
    return load_site(str(file))


def test_unknown_places_and_machines_are_errors(site: Site) -> None:
    one = tree(f"<Sequence>\n{hold('rood')}{hold('{key}')}{free('road', 'nobody')}</Sequence>")
    found = check_places(one, site, ("road",), {})
    machines = tuple(site.file.machines)
    assert found.errors == [at(4, NoPlace("rood", ("road",))), at(4, NoMachine("nobody", machines))]
    assert not found.warnings


def test_orders_that_cross_with_another_run_are_told_before_the_start(site: Site) -> None:
    one = tree(f"<Sequence>{hold('road')}{hold('yard')}{free('road')}{hold('gate')}</Sequence>")
    assert orders_of(one) == {"zx200": {("road", "yard"), ("yard", "gate")}}
    found = check_places(one, site, ("gate", "road", "yard"), {"ic120": {("yard", "road")}})
    circle = (HoldsAndTakes("zx200", "road", "yard"), HoldsAndTakes("ic120", "yard", "road"))
    assert found.warnings == [MayWaitInCircle(circle)] and not found.errors
    assert not check_places(one, site, ("gate", "road", "yard"), {"ic120": {("road", "yard")}}).warnings


def test_two_machines_of_one_tree_may_cross_too(site: Site) -> None:
    both = f"{hold('road')}{hold('yard')}{hold('yard', 'ic120')}{hold('road', 'ic120')}"
    assert len(check_places(tree(f"<Sequence>{both}</Sequence>"), site, ("road", "yard"), {}).warnings) == 1


def test_a_circle_of_others_is_not_told_again(site: Site) -> None:
    others = {"a": {("road", "yard")}, "b": {("yard", "road")}}
    assert not check_places(tree(hold("road")), site, ("road",), others).warnings
