"""Mutated field tasks: the loader loads them or refuses them with a line, and never anything else."""

from __future__ import annotations

from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from tms_ts.bt import TreeError, load
from unit.tms_ts.fakes import FakeWorld
from words import words

DATA = Path(__file__).resolve().parents[2] / "data"
FILES = [path.read_bytes() for path in sorted(DATA.glob("*_tasks/*.xml"))]
SNIPPETS = [
    b"<", b">", b'"', b"'", b"/", b"&", b"&amp;", b"\0", b"\xff", b"<!--", b"-->", b"<![CDATA[", b"{", b"}", b"=",
    b"<Sequence>", b"</Sequence>", b"<AlwaysSuccess/>", b' ID="Sequence"', b"<!DOCTYPE r>",
    b"<SubTree ID='BehaviorTree'/>",
    b"\n\t", "＿".encode(), b'num_cycles="-1"', b"<Repeat num_cycles='999999999'>", b"</Repeat>",
    b"99999999999999999999",
]  # fmt: skip


@st.composite
def mutated(draw: st.DrawFn) -> bytes:
    text = draw(st.sampled_from(FILES))
    for _ in range(draw(st.integers(1, 6))):
        start = draw(st.integers(0, len(text)))
        cut = draw(st.sampled_from([0, 0, 1, 5, 30, 400]))
        other = draw(st.sampled_from(FILES))
        piece = draw(st.one_of(st.sampled_from(SNIPPETS), st.binary(max_size=4), st.just(other[start : start + 60])))
        text = text[:start] + piece + text[start + cut :]
    return text


@given(text=mutated())
def test_mutated_tasks_load_or_are_refused(text: bytes) -> None:
    fake = FakeWorld()
    try:
        tree = load(text, world=fake.world())
    except TreeError as error:
        assert words(error.what)
        return
    try:
        for _ in range(3):
            tree.tick()
    except TreeError as error:
        assert error.path
        assert error.line
    tree.halt()
    assert not tree.running()
