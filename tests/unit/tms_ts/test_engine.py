"""The engine beyond the recorded cases: stops, exceptions, endless loops, warnings, displays, node authors."""

from __future__ import annotations

from typing import Any

import pytest

from conformance.scripted import events, scripted_registry
from tms_ts.bt import (
    FAILURE,
    IDLE,
    MISSING,
    RUNNING,
    SUCCESS,
    Condition,
    CoroAction,
    In,
    InOut,
    NodeType,
    Out,
    Status,
    SyncAction,
    TickError,
    UInt,
    load,
    node,
    registry,
)
from tms_ts.tree_reasons import MayHang, Waits
from unit.tms_ts.fakes import Clock, FakeGoal, FakeMachines, FakeWorld
from unit.tms_ts.trees import document, leaf, tree
from words import words

RETRY = '<RetryUntilSuccessful num_attempts="-1">{}</RetryUntilSuccessful>'
ENDLESS = [
    '<Repeat num_cycles="-1"><AlwaysSuccess/></Repeat>',
    RETRY.format("<Fallback><AlwaysFailure/><AlwaysFailure/></Fallback>"),
    RETRY.format("<Inverter><Sequence><AlwaysSuccess/></Sequence></Inverter>"),
    RETRY.format(f"<IfThenElse><AlwaysFailure/>{leaf()}</IfThenElse>"),
    '<Repeat num_cycles="-1"><ForceSuccess><Repeat num_cycles="5"><AlwaysFailure/></Repeat></ForceSuccess></Repeat>',
    '<Repeat num_cycles="-1"><MongoValueWriter mongo_record_name="r" mongo_param_name="p" input_value="1"/></Repeat>',
]
NOT_ENDLESS = [
    f'<Repeat num_cycles="-1">{leaf()}</Repeat>',
    '<Repeat num_cycles="-1"><Delay delay_msec="5"><AlwaysSuccess/></Delay></Repeat>',
    '<Repeat num_cycles="3"><AlwaysSuccess/></Repeat>',
    '<Repeat num_cycles="-1"><AlwaysFailure/></Repeat>',
    f'<RetryUntilSuccessful num_attempts="-1"><Sequence>{leaf()}<AlwaysFailure/></Sequence></RetryUntilSuccessful>',
    f'<Repeat num_cycles="-1"><KeepRunningUntilFailure>{leaf()}</KeepRunningUntilFailure></Repeat>',
]


class TestEndlessLoops:
    @pytest.mark.parametrize("body", ENDLESS)
    def test_yields_warns_and_stops(self, body: str) -> None:
        one = tree(body)
        assert [text for _, text in one.warnings if isinstance(text, MayHang)]
        assert one.tick() is RUNNING
        assert one.tick() is RUNNING
        one.halt()
        assert all(found.state is IDLE for found in one.nodes)

    @pytest.mark.parametrize("body", NOT_ENDLESS)
    def test_no_warning(self, body: str) -> None:
        assert not tree(body).warnings

    def test_a_long_finite_loop_gives_way_as_well(self) -> None:
        one = tree('<Repeat num_cycles="25000"><AlwaysSuccess/></Repeat>')
        statuses = [one.tick() for _ in range(3)]
        assert statuses == [RUNNING, RUNNING, SUCCESS]

    def test_nested_loops_share_one_budget(self) -> None:
        many = '<Repeat num_cycles="100000">' * 20 + "<AlwaysSuccess/>" + "</Repeat>" * 20
        changes: list[Any] = []
        one = tree(many)
        one.observers.append(lambda *change: changes.append(change))
        assert one.tick() is RUNNING
        assert len(changes) < 50_000

    def test_a_slow_child_ends_the_tick_early(self) -> None:
        clock = Clock()
        one = tree('<Repeat num_cycles="50"><AlwaysSuccess/></Repeat>', clock=clock)
        one.observers.append(lambda *_: setattr(clock, "now", clock.now + 0.001))
        assert one.tick() is RUNNING


class TestExceptions:
    def test_names_the_node_and_keeps_the_cause(self) -> None:
        one = load(document('<Sequence>\n<ScriptedAction script="S"/>\n<ScriptedSync script="X"/></Sequence>'),
                   registry=scripted_registry())  # fmt: skip
        with pytest.raises(TickError) as caught:
            one.tick()
        assert (caught.value.path, caught.value.line) == ("0.1", 5)
        assert isinstance(caught.value.__cause__, RuntimeError)
        assert "scripted exception" in str(caught.value)

    def test_a_machine_that_cannot_be_told_keeps_no_other_moving(self) -> None:
        class Broken(FakeGoal):
            def cancel(self) -> None:
                super().cancel()
                if self.record == "A":
                    raise OSError("link down")

        class Machines(FakeMachines):
            def send(self, machine: str, subtask: str, record: str, node: str) -> FakeGoal:
                self.sent.append(Broken(machine, subtask, record, node, lasts=100))
                return self.sent[-1]

        machines = Machines()
        one = tree(
            f'<Parallel success_threshold="-1">{leaf("A")}{leaf("B")}{leaf("C")}</Parallel>', fake=FakeWorld(machines)
        )
        one.tick()
        with pytest.raises(TickError, match="link down") as caught:
            one.halt()
        assert caught.value.path == "0.0"
        assert [goal.cancels for goal in machines.sent] == [1, 1, 1]
        assert all(found.state is IDLE for found in one.nodes)

    def test_an_observer_that_raises_keeps_no_machine_moving(self) -> None:
        fake = FakeWorld(FakeMachines(lasts=100))
        one = tree(f'<Parallel success_threshold="-1">{leaf("A")}{leaf("B")}</Parallel>', fake=fake)
        one.tick()

        def broken(*change: Any) -> None:
            raise OSError("journal is away")

        one.observers.append(broken)
        with pytest.raises(TickError, match="journal is away"):
            one.halt()
        assert [goal.cancels for goal in fake.machines.sent] == [1, 1]
        assert all(found.state is IDLE for found in one.nodes)


class TestTimers:
    def test_a_poll_lets_a_timer_expire(self) -> None:
        fake = FakeWorld(FakeMachines(lasts=100))
        one = tree(f'<Timeout msec="1500">{leaf()}</Timeout>', fake=fake)
        one.tick()
        fake.clock.now = 1.4
        one.poll()
        assert [goal.cancels for goal in fake.machines.sent] == [0]
        fake.clock.now = 2.0
        one.poll()
        assert [goal.cancels for goal in fake.machines.sent] == [1]
        assert one.tick() is FAILURE
        assert not one.context.timers

    def test_delay_tells_why_it_runs(self) -> None:
        one = tree('<Delay delay_msec="2500"><AlwaysSuccess/></Delay>')
        one.tick()
        assert one.root.reason == Waits(2.5)

    def test_a_halted_timeout_starts_afresh(self) -> None:
        fake = FakeWorld(FakeMachines(lasts=100))
        one = tree(f'<Timeout msec="100">{leaf()}</Timeout>', fake=fake)
        one.tick()
        one.halt()
        fake.clock.now = 0.09
        one.tick()
        fake.clock.now = 0.15
        assert one.tick() is RUNNING
        fake.clock.now = 0.2
        assert one.tick() is FAILURE


class TestTree:
    def test_nodes(self) -> None:
        one = tree(
            '<Sequence name="a">\n<Inverter><AlwaysFailure/></Inverter>\n<SubTree ID="T1"/></Sequence>',
            "<AlwaysSuccess/>",
        )
        assert [(n.path, n.registration_name, n.name, n.line) for n in one.nodes] == [
            ("0", "Sequence", "a", 3),
            ("0.0", "Inverter", "Inverter", 4),
            ("0.0.0", "AlwaysFailure", "AlwaysFailure", 4),
            ("0.1", "SubTree", "T1", 5),
            ("0.1.0", "AlwaysSuccess", "AlwaysSuccess", 6),
        ]
        uids = [n.uid for n in one.nodes]
        assert uids == list(range(uids[0], uids[0] + 5)) or 65_535 in uids
        assert set(uids).isdisjoint(n.uid for n in tree("<AlwaysSuccess/>").nodes)
        assert [n.kind for n in one.nodes][3] is NodeType.SUBTREE

    def test_assigned_ports_as_written(self) -> None:
        one = tree('<Repeat num_cycles="${n}"><SetBlackboard value="=" output_key="k"/></Repeat>')
        assert one.nodes[0].assigned() == {"num_cycles": "${n}"}
        assert one.nodes[1].assigned() == {"value": "=", "output_key": "k"}

    def test_preflight_of_what_throws(self) -> None:
        one = tree('<Sequence><Repeat><AlwaysSuccess/></Repeat><IfThenElse><AlwaysSuccess/></IfThenElse>'
                   '<WhileDoElse><AlwaysSuccess/></WhileDoElse><Switch2 variable="1"><AlwaysSuccess/></Switch2>'
                   '<Delay delay_msec="soon"><AlwaysSuccess/></Delay></Sequence>')  # fmt: skip
        texts = " ".join([words(what) for _, what in one.warnings] + [words(fault.reason) for fault in one.faults])
        for part in (
            "needs 'num_cycles'",
            "2 or 3 children",
            "WhileDoElse must have 3",
            "Switch2 must have 3",
            "'soon'",
        ):
            assert part in texts


class Adder(SyncAction):
    """Add two numbers.

    a: the first
    """

    a: In[int]
    b: In[int] = 5
    sum_: Out[int]
    from_: InOut[str] = "x"
    many: In[list[int]]
    flags: In[UInt] = UInt(0)

    def tick(self) -> Status:
        self.sum_ = self.a + self.b
        return SUCCESS


class Loud(Condition):
    def check(self) -> bool:
        return self.read("limit") is not MISSING

    limit: In[float]


class Twice(CoroAction):
    def run(self) -> Any:
        yield
        events.append((self, "second"))
        return SUCCESS


class TestAuthors:
    def test_ports_are_fields(self) -> None:
        known = registry().extended(Adder, Loud, Twice)
        assert "Adder" not in registry()
        assert list(known["Adder"].ports) == ["a", "b", "sum", "from", "many", "flags"]
        assert known["Adder"].ports["a"].help == "the first"
        one = load(
            document('<Sequence><Adder a="2" sum="{s}" many="1;2;x"/><Loud limit="0.5"/><Twice/></Sequence>'),
            registry=known,
        )
        assert one.tick() is RUNNING
        assert dict(one.blackboards[0].items()) == {"s": 7}
        assert one.nodes[1].read("many") == [1, 2, 0]
        assert one.tick() is SUCCESS

    def test_missing_input_and_output(self) -> None:
        known = registry().extended(Adder)
        for body, text in (
            ("<Adder sum='{s}'/>", "missing parameter 'a'"),
            ("<Adder a='1'/>", "'sum' is not connected"),
        ):
            with pytest.raises(TickError, match=text):
                load(document(body), registry=known).tick()

    def test_a_port_must_not_hide_a_field_of_every_node(self) -> None:
        class Bad(SyncAction):
            path: In[str]  # type: ignore[assignment]

        with pytest.raises(TypeError, match="would hide"):
            registry().extended(Bad)

    def test_two_classes_of_one_name(self) -> None:
        other = type("AlwaysSuccess", (SyncAction,), {})
        with pytest.raises(TypeError, match="is defined in"):
            node(other)


def test_only_branches_of_a_parallel_do_not_wait_for_each_other() -> None:
    one = leaf("a")
    made = tree(
        f'<Sequence><Parallel success_threshold="2"><Sequence>{one}{one}</Sequence>{one}</Parallel>{one}</Sequence>'
    )
    assert made.beside("0.0.0.1", "0.0.1")
    assert not made.beside("0.0.0.0", "0.0.0.1")  # of one branch
    assert not made.beside("0.0.1", "0.1")  # the Sequence above it
    assert not made.beside("0.1", "0.1")
