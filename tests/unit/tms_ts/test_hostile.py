"""Hostile and broken documents: one clear error, quickly."""

from __future__ import annotations

import difflib
import time
from pathlib import Path

import pytest

from tms_ts.bt import TreeError, check, load
from tms_ts.bt.errors import MAX_NAMES, MAX_WARNINGS, did_you_mean
from tms_ts.tree_reasons import DidYouMean, MayHang
from unit.tms_ts.trees import document
from words import words

LAUGHS = [f'<Sequence><SubTree ID="T{i + 1}"/><SubTree ID="T{i + 1}"/></Sequence>' for i in range(1, 31)]
CHAIN = [f'<SubTree ID="T{i + 1}"/>' for i in range(1, 300)]
HOSTILE: list[tuple[str, str | bytes, str]] = [
    ("empty", "", "empty"),
    ("blank", " \n\t", "empty"),
    ("file name", "task.xml", "not XML"),
    ("nul", "<root>\n\0</root>", "NUL"),
    ("latin 1", b"<root>\n<a x='\xe9'/></root>", "not UTF-8"),
    ("utf-16", "<root/>".encode("utf-16"), "not UTF-8"),
    ("entity bomb", '<?xml version="1.0"?><!-- a --><!DOCTYPE l [<!ENTITY a "x">]><root>&a;</root>', "DTD"),
    ("external entity", '<!DOCTYPE r [<!ENTITY x SYSTEM "file:///etc/passwd">]><root>&x;</root>', "DTD"),
    ("external dtd", '<!DOCTYPE r SYSTEM "http://example.org/x.dtd"><root/>', "DTD"),
    ("unknown entity", "<root>&foo;</root>", "not well-formed"),
    ("deep", document("<Inverter>" * 10_000 + "</Inverter>" * 10_000), "nested deeper than 200"),
    ("a little too deep", document("<Inverter>" * 205 + "<AlwaysSuccess/>" + "</Inverter>" * 205), "deeper than 200"),
    ("many tags", document("<Sequence>" + "<AlwaysSuccess/>" * 250_000 + "</Sequence>"), "tags"),
    ("many nodes", document("<Sequence>" + "<AlwaysSuccess/>" * 20_001 + "</Sequence>"), "more than 20000 nodes"),
    ("many attributes", document("<A " + " ".join(f"a{i}=''" for i in range(100_000)) + "/>"), "too many attributes"),
    ("long name", document(f"<{'a' * 60_000}/>"), ""),
    ("large", "<root>" + " " * 5_000_000 + "</root>", "larger than 5000000 bytes"),
    ("unclosed comments", "<root>" + "<!--" * 190_000, "not well-formed"),
    ("tree in itself", document('<SubTree ID="T1"/>', '<SubTree ID="M"/>'), "contains itself"),
    ("doubling trees", document('<SubTree ID="T1"/>', *LAUGHS, "<AlwaysSuccess/>"), "more than 20000 nodes"),
    ("long chain of trees", document('<SubTree ID="T1"/>', *CHAIN, "<AlwaysSuccess/>"), "deeper than 200"),
]


@pytest.mark.parametrize(("text", "message"), [case[1:] for case in HOSTILE], ids=[case[0] for case in HOSTILE])
def test_one_clear_error_quickly(text: str | bytes, message: str) -> None:
    start = time.monotonic()
    with pytest.raises(TreeError) as caught:
        load(text)
    assert time.monotonic() - start < 10  # s, on a busy machine; alone all take less than 1
    assert message in words(caught.value.what)
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 700
    assert not check(text).ok


def test_a_huge_file_is_not_read(tmp_path: Path) -> None:
    huge = tmp_path / "huge.xml"
    with huge.open("wb") as file:
        file.truncate(100_000_000)
    start = time.monotonic()
    with pytest.raises(TreeError, match="larger than"):
        load(huge)
    assert time.monotonic() - start < 5


def test_the_text_may_declare_any_encoding() -> None:
    text = '<?xml version="1.0" encoding="Shift_JIS"?>\n' + document("<AlwaysSuccess name='待機'/>")
    assert load(text.encode()).root.name == "待機"
    assert load("\ufeff" + text).root.line == 4


def test_a_line_that_lxml_cannot_count_to_is_its_last_one() -> None:
    text = document("\n" * 70_000 + '<Sequence\n><AlwaysSuccess name="x"/></Sequence>')
    assert load(text).root.line == 65_535
    assert check(text).ok


NAMES = [f"dig_and_load_{number}" for number in range(MAX_NAMES)]


def test_a_near_name_is_not_looked_for_among_thousands(monkeypatch: pytest.MonkeyPatch) -> None:
    assert did_you_mean("dig_and_lode_7", NAMES) == DidYouMean("dig_and_load_7")
    monkeypatch.setattr(difflib, "get_close_matches", None)
    assert did_you_mean("dig_and_lode_7", [*NAMES, "one more"]) is None


@pytest.mark.parametrize("main", ["", 'main_tree_to_execute="none"'])
def test_a_hint_does_not_list_thousands_of_names(main: str) -> None:
    trees = "".join(f'<BehaviorTree ID="{name}"><AlwaysSuccess/></BehaviorTree>' for name in [*NAMES, "one more"])
    (error,) = check(f"<root {main}>{trees}</root>").errors
    assert "one of" in words(error.hint) or "there is" in words(error.hint)
    assert len(str(error)) < 700


MANY = '<Action ID="AlwaysSucces"/>\n' * 100_000
TWICE = '<BehaviorTree ID="M"><AlwaysFailure/></BehaviorTree>\n' * 9000
UNUSED = {
    "tree": document("<AlwaysSuccess/>", f"<Sequence>{MANY}</Sequence>").replace("T1", "T" * 1000),
    "inside": document(f'<SubTreePlus ID="T1">{MANY}</SubTreePlus>', "<AlwaysSuccess/>"),
    "twice": document("<AlwaysSuccess/>").replace("</root>", f"{TWICE}</root>"),
}


@pytest.mark.turns
@pytest.mark.parametrize("text", UNUSED.values(), ids=UNUSED)
def test_warnings_about_what_is_not_used_are_bounded(text: str) -> None:
    """Each of them looks for a near name, which 160 000 times took half a minute."""
    start = time.process_time()
    loaded = load(text)
    report = check(text)
    assert time.process_time() - start < 20  # s of a core, slowed down by its neighbours; alone it takes 4
    assert len(loaded.warnings) == len(report.warnings) == MAX_WARNINGS
    assert max(len(words(warning)) for _, warning in loaded.warnings) <= 400


def test_what_is_not_used_does_not_hide_warnings_about_what_is() -> None:
    body = '<Repeat num_cycles="-1"><AlwaysSuccess/></Repeat>'
    assert isinstance(load(document(body, f"<Sequence>{MANY}</Sequence>")).warnings[0][1], MayHang)
