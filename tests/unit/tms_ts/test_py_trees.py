"""py_trees at both borders: its behaviours are leaves of our trees, and its displays and visitors see any tree."""

import threading
import time
from collections.abc import Callable
from typing import Any

import py_trees
import pydot
import pytest
from lxml import etree
from py_trees.behaviour import Behaviour
from py_trees.behaviours import Periodic, Running, SetBlackboardVariable, StatusQueue, TickCounter
from py_trees.common import Status as PyTreesStatus
from py_trees.composites import Sequence as PyTreesSequence
from py_trees.timers import Timer

from tms_reason.reason import Foreign
from tms_ts.bt import FAILURE, IDLE, RUNNING, SUCCESS, In, Out, PyTreesLeaf, TickError, Tree, load, palette, registry
from tms_ts.bt.display import ascii_tree, dot, twin
from tms_ts.bt.leaf import SyncAction
from tms_ts.bt.status import Status
from tms_ts.tree_reasons import ActionIdle, NodeError, PyTreesBlackboard, UsePorts, WaitsForWorkers
from unit.tms_ts.fakes import FakeMachines, FakeWorld
from unit.tms_ts.trees import document, leaf, tree


class CountTicks(PyTreesLeaf):
    """Run for some ticks.

    ticks: how many
    """

    ticks: In[int] = 2

    def behaviour(self) -> TickCounter:
        return TickCounter(self.name, self.ticks, PyTreesStatus.SUCCESS)


class Pause(PyTreesLeaf):
    """Wait by the wall clock."""

    seconds: In[float]

    def behaviour(self) -> Timer:
        return Timer(self.name, self.seconds)


class Measuring(Behaviour):
    """Measures on a thread of its own until it is told to stop."""

    stubborn = False  # whether it goes on although it was told to end

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.calls: list[str] = []
        self.over, self.released, self.result = threading.Event(), threading.Event(), 0
        self.thread = threading.Thread(target=self.measure, name="measuring")

    def measure(self) -> None:
        self.over.wait(60)
        if self.stubborn:
            self.released.wait(60)

    def setup(self, **kwargs: Any) -> None:
        self.calls.append("setup")

    def initialise(self) -> None:
        self.calls.append("initialise")
        self.thread.start()

    def update(self) -> PyTreesStatus:
        self.calls.append("update")
        self.feedback_message = "measures"
        if not self.thread.is_alive():
            self.result = 7
            return PyTreesStatus.SUCCESS
        return PyTreesStatus.RUNNING

    def terminate(self, new_status: PyTreesStatus) -> None:
        self.calls.append(f"terminate {new_status.value}")
        self.over.set()

    def shutdown(self) -> None:
        self.calls.append("shutdown")


class Measure(PyTreesLeaf):
    """Measure, and tell the result."""

    made: list[Measuring]
    result: Out[int]

    def behaviour(self) -> Behaviour:
        self.made.append(Measuring(self.name))
        return self.made[-1]

    def ended(self, behaviour: Behaviour) -> None:
        assert isinstance(behaviour, Measuring)
        self.result = behaviour.result


def made_by(make: Callable[[], Behaviour]) -> type[PyTreesLeaf]:
    return type("Made", (PyTreesLeaf,), {"behaviour": lambda self: make()})


@pytest.fixture
def measuring() -> list[Measuring]:
    Measure.made = []
    return Measure.made


def loaded(body: str, *kinds: type[PyTreesLeaf], **options: Any) -> Tree:
    known = registry().extended(*(kinds or (CountTicks, Pause, Measure)))
    return load(document(body), registry=known, **options)


def ended(worker: threading.Thread) -> bool:
    worker.join(10)
    return not worker.is_alive()


class TestBehaviourOfPyTrees:
    def test_a_tick_counter_runs_and_begins_anew(self) -> None:
        one = loaded('<CountTicks ticks="2"/>')
        assert [one.tick() for _ in range(6)] == [RUNNING, RUNNING, SUCCESS] * 2

    def test_a_timer_waits_by_its_clock_and_says_so(self, monkeypatch: pytest.MonkeyPatch) -> None:
        now = [100.0]
        monkeypatch.setattr(time, "time", lambda: now[0])
        one = loaded('<Pause seconds="2.5"/>')
        assert [one.tick(), one.tick()] == [RUNNING, RUNNING]
        assert one.root.reason == Foreign("still running")
        now[0] = 102.6
        assert one.tick() is SUCCESS

    def test_ports_are_read_at_each_start(self) -> None:
        class More(SyncAction):
            n: In[int]
            out: Out[int]

            def tick(self) -> Status:
                self.out = self.n + 2
                return SUCCESS

        known = registry().extended(CountTicks, More)
        body = '<Sequence><CountTicks ticks="{n}"/><More n="{n}" out="{n}"/></Sequence>'
        one = load(document(body), registry=known, blackboard={"n": 0})
        assert [one.tick() for _ in range(5)] == [SUCCESS, RUNNING, RUNNING, SUCCESS, RUNNING]

    def test_a_default_of_a_port_and_the_palette(self) -> None:
        assert [loaded("<CountTicks/>").tick() for _ in range(2)] == [RUNNING, RUNNING]
        entry = etree.fromstring(palette(registry().extended(CountTicks))).find(".//Action[@ID='CountTicks']")
        assert entry is not None
        assert [(port.get("name"), port.get("type"), port.get("default"), port.text) for port in entry] == [
            ("ticks", "int", "2", "how many")
        ]

    def test_a_failure_is_one(self) -> None:
        queue = [PyTreesStatus.RUNNING, PyTreesStatus.FAILURE]
        one = loaded("<Made/>", made_by(lambda: StatusQueue("q", queue, None)))
        assert [one.tick(), one.tick()] == [RUNNING, FAILURE]

    def test_a_whole_tree_of_py_trees_is_one_leaf(self) -> None:
        inner = [TickCounter("a", 1, PyTreesStatus.SUCCESS), Running("b")]
        root = PyTreesSequence("s", memory=True, children=inner)
        one = loaded("<Made/>", made_by(lambda: root))
        assert [one.tick(), one.tick()] == [RUNNING, RUNNING]
        assert inner[1].status is PyTreesStatus.RUNNING
        one.halt()
        assert {found.status for found in root.iterate()} == {PyTreesStatus.INVALID}

    def test_invalid_is_no_result(self) -> None:
        one = loaded("<Made/>", made_by(lambda: StatusQueue("q", [PyTreesStatus.INVALID], None)))
        with pytest.raises(TickError) as caught:
            one.tick()
        assert (caught.value.path, caught.value.what) == ("0", ActionIdle("Made"))

    def test_the_blackboard_that_all_runs_would_share_is_refused(self) -> None:
        shared = SetBlackboardVariable("set", "key", 1, overwrite=True)
        with pytest.raises(TickError) as caught:
            loaded("<Made/>", made_by(lambda: shared)).tick()
        assert (caught.value.what, caught.value.hint) == (PyTreesBlackboard("Made"), UsePorts())

    def test_what_a_behaviour_logs_does_not_go_to_stdout(self, capsys: pytest.CaptureFixture[str]) -> None:
        class Talks(Running):  # type: ignore[misc, valid-type]
            def initialise(self) -> None:
                self.logger.info("begins")

        loaded("<Made/>", made_by(lambda: Talks("t"))).tick()
        assert "py_trees" not in capsys.readouterr().out


class TestThreads:
    def test_life_of_a_behaviour_that_completes(self, measuring: list[Measuring]) -> None:
        one = loaded('<Measure result="{r}"/>')
        assert one.tick() is RUNNING
        measuring[0].over.set()
        assert ended(measuring[0].thread)
        assert one.tick() is SUCCESS
        calls = ["setup", "initialise", "update", "update", "terminate SUCCESS", "shutdown"]
        assert measuring[0].calls == calls
        assert dict(one.blackboards[0].items()) == {"r": 7}
        one.halt()
        assert measuring[0].calls == calls, "what has ended is not stopped"

    def test_a_halt_ends_the_thread(self, measuring: list[Measuring]) -> None:
        one = loaded('<Measure result="{r}"/>')
        one.tick()
        one.halt()
        assert measuring[0].calls[-2:] == ["terminate INVALID", "shutdown"]
        assert ended(measuring[0].thread)
        assert not one.workers()
        assert one.root.state is IDLE

    def test_a_parent_that_goes_on_ends_it_as_well(self, measuring: list[Measuring]) -> None:
        body = '<ReactiveFallback><BlackboardCheckBool value_A="{up}" value_B="true"><AlwaysSuccess/>' \
               '</BlackboardCheckBool><Measure result="{r}"/></ReactiveFallback>'  # fmt: skip
        one = loaded(body, blackboard={"up": False})
        assert one.tick() is RUNNING
        one.blackboards[0].set("up", True)
        assert one.tick() is SUCCESS
        assert ended(measuring[0].thread)

    def test_a_halt_waits_for_no_thread_and_the_next_start_does(
        self, measuring: list[Measuring], monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr(Measuring, "stubborn", True)
        one = loaded('<Measure result="{r}"/>')
        one.tick()
        begun = time.monotonic()
        one.halt()
        assert time.monotonic() - begun < 5  # s; the thread goes on for a minute
        assert one.workers() == [measuring[0].thread]
        assert [one.tick(), one.tick()] == [RUNNING, RUNNING]
        assert len(measuring) == 1
        assert one.root.reason == WaitsForWorkers()
        measuring[0].released.set()
        assert ended(measuring[0].thread)
        assert one.tick() is RUNNING
        assert len(measuring) == 2
        one.halt()
        measuring[1].released.set()
        assert ended(measuring[1].thread)

    def test_an_exception_leaves_no_thread_behind(
        self, measuring: list[Measuring], monkeypatch: pytest.MonkeyPatch
    ) -> None:
        def broken(self: Measuring) -> PyTreesStatus:
            raise ValueError("no sensor")

        monkeypatch.setattr(Measuring, "update", broken)
        one = loaded('<Sequence><Measure result="{r}"/></Sequence>')
        with pytest.raises(TickError) as caught:
            one.tick()
        assert caught.value.what == NodeError("ValueError", "no sensor")
        one.halt()
        assert ended(measuring[0].thread)
        assert measuring[0].calls[-1] == "shutdown"

    def test_a_behaviour_that_cannot_be_stopped_keeps_no_machine_moving(
        self, measuring: list[Measuring], monkeypatch: pytest.MonkeyPatch
    ) -> None:
        def broken(self: Measuring, new_status: PyTreesStatus) -> None:
            self.over.set()
            raise OSError("link down")

        monkeypatch.setattr(Measuring, "terminate", broken)
        fake = FakeWorld(FakeMachines(lasts=100))
        body = f'<Parallel success_threshold="-1"><Measure result="{{r}}"/>{leaf()}</Parallel>'
        one = loaded(body, world=fake.world())
        one.tick()
        with pytest.raises(TickError) as caught:
            one.halt()
        assert caught.value.what == NodeError("OSError", "link down")
        assert [goal.cancels for goal in fake.machines.sent] == [1]
        assert measuring[0].calls[-1] == "shutdown"
        assert ended(measuring[0].thread)


KINDS = """<Sequence name="all"><Fallback><AlwaysSuccess/></Fallback>
<ReactiveSequence><AlwaysSuccess/></ReactiveSequence>
<ReactiveFallback><AlwaysSuccess/></ReactiveFallback><Parallel success_threshold="1"><AlwaysSuccess/></Parallel>
<IfThenElse><AlwaysSuccess/><AlwaysFailure/></IfThenElse><Inverter><AlwaysSuccess/></Inverter>
<SubTree ID="T1"/></Sequence>"""
NASTY = ['a "b" \\ c', "x: y -> z", "{k} <b>", "待機", "node", "", "1.5", "a\nb"]


@pytest.mark.filterwarnings("ignore:.*deprecated:DeprecationWarning")  # of the reader of pydot
class TestDisplays:
    def test_every_kind_has_its_symbol(self) -> None:
        lines = ascii_tree(tree(KINDS, "<AlwaysFailure/>")).splitlines()
        assert [line.strip() for line in lines if "Always" not in line] == [
            "{-} all (Sequence)",
            "{o} Fallback",
            "[-] ReactiveSequence",
            "[o] ReactiveFallback",
            '/_/ Parallel success_threshold="1"',
            "--> IfThenElse",
            "-^- Inverter",
            "-^- T1 (SubTree)",
        ]
        assert [len(line) - len(line.lstrip()) for line in lines[:3]] == [0, 4, 8]

    def test_ports_status_and_reason(self) -> None:
        one = tree(f"<Sequence><AlwaysSuccess/>{leaf('{next}')}</Sequence>", blackboard={"next": "A"})
        one.tick()
        text = ascii_tree(one, status=True)
        assert 'model_name="zx200" record_name="{next}" subtask_name="st_zx200_swing"' in text
        assert "on the way" in text
        assert py_trees.console.blue + "*" in text

    def test_dot_is_a_graph_of_all_nodes(self) -> None:
        one = tree(KINDS, "<AlwaysFailure/>")
        (graph,) = pydot.graph_from_dot_data(dot(one)) or ()
        names = [found for found in graph.get_node_list() if found.get_name() not in ("graph", "node", "edge")]
        assert len(names) == len(one.nodes)
        assert len(graph.get_edges()) == len(one.nodes) - 1
        assert {found.get("shape") for found in names} == {"box", "octagon", "parallelogram", "ellipse"}

    @pytest.mark.parametrize("name", NASTY)
    def test_dot_with_any_name(self, name: str) -> None:
        quoted = name.replace("&", "&amp;").replace('"', "&quot;").replace("<", "&lt;").replace("\n", "&#10;")
        one = tree(f'<Sequence name="{quoted}"><AlwaysSuccess name="{quoted}"/><AlwaysFailure/></Sequence>')
        (graph,) = pydot.graph_from_dot_data(dot(one)) or ()
        assert [(edge.get_source(), edge.get_destination()) for edge in graph.get_edges()] == [
            ("0", "0.0"),
            ("0", "0.1"),
        ]
        label = str(graph.get_node("0.0")[0].get("label")).removeprefix('"').removesuffix('"')
        assert label.replace('\\"', '"').replace("\\n", "\n").replace("\\\\", "\\") == f"{name} (AlwaysSuccess)"

    def test_a_deep_tree_is_shown(self) -> None:
        body = "<Inverter>" * 150 + "<AlwaysSuccess/>" + "</Inverter>" * 150
        assert len(ascii_tree(tree(body)).splitlines()) == 151
        assert dot(tree(body)).count("->") == 150

    def test_visitors_see_nodes_with_lasting_ids(self) -> None:
        one = tree(f"<Sequence name='all'><AlwaysSuccess/>{leaf()}</Sequence>")
        before = {found.id for found in twin(one.root).iterate()}
        one.tick()
        visitor = py_trees.visitors.SnapshotVisitor()
        visitor.initialise()
        for found in twin(one.root).iterate():
            found.visit(visitor)
        assert set(visitor.visited) == before
        assert [found.status for found in twin(one.root).iterate()] == [
            PyTreesStatus.SUCCESS,
            PyTreesStatus.RUNNING,
            PyTreesStatus.RUNNING,
        ]

    def test_twins_do_not_touch_the_tree(self) -> None:
        one = loaded("<Made/>", made_by(lambda: Periodic("p", 1)))
        twin(one.root).tick_once()
        assert one.root.state is IDLE
