"""Random trees: after a halt nothing is RUNNING and each leaf that was RUNNING has been halted exactly once."""

from __future__ import annotations

from collections import Counter
from typing import Any

from hypothesis import given
from hypothesis import strategies as st

from conformance.scripted import events, scripted_registry
from tms_ts.bt import IDLE, Status, TreeError, load
from unit.tms_ts.fakes import Clock
from unit.tms_ts.trees import document

REGISTRY = scripted_registry()
LEAVES = ("ScriptedAction", "ScriptedSync", "ScriptedCondition", "ScriptedPlain", "ScriptedCoro")
HALTING = ("ScriptedAction", "ScriptedPlain", "ScriptedCoro")
KINDS = ("Sequence", "Fallback", "SequenceStar", "ReactiveSequence", "ReactiveFallback", "Parallel")
DECORATORS = (
    "Inverter", "ForceSuccess", "ForceFailure", 'Repeat num_cycles="3"', 'Repeat num_cycles="-1"',
    'RetryUntilSuccessful num_attempts="2"', 'RetryUntilSuccessful num_attempts="-1"', "KeepRunningUntilFailure",
    'Delay delay_msec="15"', 'Timeout msec="25"', 'KeepRunningUntilFlgup key="k"',
    'BlackboardCheckInt value_A="{a}" value_B="1" return_on_mismatch="RUNNING"',
)  # fmt: skip


@st.composite
def leaves(draw: st.DrawFn) -> str:
    kind = draw(st.sampled_from(LEAVES))
    letters = draw(st.text("SFRRX" if kind != "ScriptedSync" else "SFX", min_size=1, max_size=5))
    return f'<{kind} script="{letters}"/>'


def control(children: list[str], kind: str) -> str:
    threshold = f' success_threshold="{len(children)}"' if kind == "Parallel" else ""
    return f"<{kind}{threshold}>{''.join(children)}</{kind}>"


def branch(children: list[str]) -> str:
    kind = "WhileDoElse" if len(children) == 3 else "IfThenElse"
    return f"<{kind}>{''.join(children)}</{kind}>"


def extend(inner: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    several = st.lists(inner, min_size=1, max_size=4)
    return st.one_of(
        st.builds(control, several, st.sampled_from(KINDS)),
        st.builds(branch, st.lists(inner, min_size=2, max_size=3)),
        st.builds(lambda child, d: f"<{d}>{child}</{d.split()[0]}>", inner, st.sampled_from(DECORATORS)),
        st.builds(
            lambda a, b, c: f'<Switch2 variable="1" case_1="1" case_2="2">{a}{b}{c}</Switch2>', inner, inner, inner
        ),
    )


TREES = st.recursive(leaves(), extend, max_leaves=12)


@given(body=TREES, halts=st.lists(st.booleans(), min_size=1, max_size=12))
def test_a_halt_leaves_nothing_running_and_halts_each_leaf_once(body: str, halts: list[bool]) -> None:
    clock = Clock()
    tree = load(document(body), registry=REGISTRY, clock=clock)
    for halt in halts:
        clock.now += 0.01
        events.clear()
        raised = False
        try:
            tree.tick()
        except TreeError as error:
            raised = True
            assert error.path in {node.path for node in tree.nodes}
        if not (halt or raised):
            continue
        running = {node for node in tree.running() if node.registration_name in HALTING}
        events.clear()
        tree.halt()
        assert all(node.state is IDLE for node in tree.nodes)
        assert Counter(event[0] for event in events if event[1] == "halt") == Counter(running)
        assert not tree.context.timers
        events.clear()
        tree.halt()
        assert not events


@given(body=TREES, ticks=st.integers(1, 8))
def test_observers_see_every_change(body: str, ticks: int) -> None:
    tree = load(document(body), registry=REGISTRY, clock=Clock())
    seen: dict[Any, Status] = dict.fromkeys(tree.nodes, IDLE)

    def observe(node: Any, old: Status, new: Status) -> None:
        assert seen[node] is old
        assert old is not new
        seen[node] = new

    tree.observers.append(observe)
    for _ in range(ticks):
        try:
            tree.tick()
        except TreeError:
            tree.halt()
        assert all(node.state is seen[node] for node in tree.nodes)
