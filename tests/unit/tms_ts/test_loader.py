"""What the loader refuses and how it says so; what it takes."""

from __future__ import annotations

from pathlib import Path

import pytest

from tms_ts.bt import SUCCESS, In, SyncAction, TreeError, check, load, registry
from tms_ts.tree_reasons import AdoptedLeaf, InSubTreePlus, NotUsed, TwoTrees
from unit.tms_ts.trees import document, leaf, tree
from words import words

REFUSED = [
    ("<Sequense><AlwaysSuccess/></Sequense>", 3, "no node 'Sequense'", "did you mean 'Sequence'?"),
    ("<Sequence/>", 3, "needs at least one child", ""),
    ("<Control ID='Parallel'/>", 3, "needs at least one child", ""),
    ("<Inverter><AlwaysSuccess/><AlwaysSuccess/></Inverter>", 3, "exactly one child, it has 2", ""),
    ("<Decorator ID='Inverter'/>", 3, "exactly one child, it has 0", ""),
    ("<Action ID='AlwaysSuccess'><AlwaysSuccess/></Action>", 3, "has no children", ""),
    ("<Action/>", 3, "<Action> needs an ID", ""),
    ("<AlwaysSuccess/><AlwaysFailure/>", 2, "exactly one child, it has 2", ""),
    ("<Repeat\n num_cycle='1'>\n<AlwaysSuccess/></Repeat>", 3, "no port 'num_cycle'", "did you mean 'num_cycles'?"),
    ("<Sequence>\n\n<AlwaysSuccess foo='1'/></Sequence>", 5, "no port 'foo', possibly a typo", "it has no ports"),
    ("<SubTree ID='Nope'/>", 3, "there is no tree 'Nope'", ""),
    ("<SubTree/>", 3, "<SubTree> needs an ID", ""),
    ("<SubTree ID='T1'><AlwaysSuccess/></SubTree>", 3, "a SubTree has no children", ""),
    ("<T1/>", 3, "<T1> is a tree, not a node", '<SubTree ID="T1"/>'),
    ("<SubTree ID='M'/>", 3, "contains itself (M -> M)", ""),
    ("<SubTree ID='T1' __shared_blackboard='maybe'/>", 3, "is not true or false", ""),
    ("<RetryUntilSuccesful num_attempts='1'><AlwaysSuccess/></RetryUntilSuccesful>", 3, "", "'RetryUntilSuccessful'"),
    ("<ManualSelector><AlwaysSuccess/></ManualSelector>", 3, "no node 'ManualSelector'", "terminal"),
    ("<LeafNodeZx200 record_name='r'/>", 3, "LeafNodeZx200 needs 'subtask_name'", ""),
    ("<Sequence><Repeat num_cycles='{a}'><AlwaysSuccess/></Repeat>\n<Delay delay_msec='{a}'><AlwaysSuccess/></Delay>"
     "</Sequence>", 4, "the key 'a' is of type int already", "use another key"),
]  # fmt: skip


@pytest.mark.parametrize(("body", "line", "message", "hint"), REFUSED)
def test_refused_with_line_and_hint(body: str, line: int, message: str, hint: str) -> None:
    with pytest.raises(TreeError) as caught:
        load(document(body, "<AlwaysSuccess/>"))
    assert caught.value.line == line
    assert message in words(caught.value.what)
    assert hint in words(caught.value.hint)
    assert caught.value.path
    assert f"line {line}" in str(caught.value)
    assert str(check(document(body, "<AlwaysSuccess/>")).errors[0]) == str(caught.value)


WHOLE = [
    (
        "<root><BehaviorTree ID='M'><AlwaysSuccess/></BehaviorTree><TreeNodesModel/>\n<TreeNodesModel/></root>",
        2,
        "more",
    ),
    ("<tree/>", 1, "must be <root>"),
    ("<root main_tree_to_execute='X'><BehaviorTree ID='M'><AlwaysSuccess/></BehaviorTree></root>", 1, "unknown tree"),
    ("<root/>", 1, "main_tree_to_execute is not given"),
    ("<root>\n<a></root>", 2, "not well-formed"),
    ("<root><BehaviorTree ID='M'><AlwaysSuccess name='a' name='b'/></BehaviorTree></root>", 1, "not well-formed"),
]


@pytest.mark.parametrize(("text", "line", "message"), WHOLE)
def test_refused_documents(text: str, line: int, message: str) -> None:
    with pytest.raises(TreeError, match=message) as caught:
        load(text)
    assert caught.value.line == line


def test_check_tells_all_errors() -> None:
    report = check(document("<Sequence><Foo/>\n<Bar/><AlwaysSuccess x='1'/></Sequence>"))
    assert [error.line for error in report.errors] == [3, 4, 4]
    assert report.errors[0].path == "M/Sequence/Foo"


def test_check_lists_goals_without_running() -> None:
    report = check(document(f"<Sequence>{leaf('A')}\n{leaf('{next}')}</Sequence>"))
    assert report.ok
    assert [(g.machine, g.subtask, g.record, g.path, g.line) for g in report.goals] == [
        ("zx200", "st_zx200_swing", "A", "0.0", 3),
        ("zx200", "st_zx200_swing", "{next}", "0.1", 4),
    ]


def test_lines_count_from_the_beginning_of_a_tag() -> None:
    loaded = tree("<Sequence\n name='a\nb'>\n<AlwaysSuccess\n name='x'/></Sequence>")
    assert [node.line for node in loaded.nodes] == [3, 6]
    assert loaded.root.name == "a\nb"


def test_unknown_leaf_with_the_leaf_ports_in_the_palette() -> None:
    ports = "".join(f'<input_port name="{p}"/>' for p in (" model_name", "record_name", "subtask_name", "speed"))
    model = f'<TreeNodesModel><Action ID="LeafNodeNew"> {ports}</Action><Action ID="Other"/></TreeNodesModel>'
    loaded = load(document(leaf(model="New"), model=model))
    assert [goal.machine for goal in loaded.leaf_goals()] == ["zx200"]
    assert loaded.warnings == [(3, AdoptedLeaf("LeafNodeNew"))]
    with pytest.raises(TreeError, match="no node 'Other'"):
        load(document('<Action ID="Other"/>', model=model))


class TestUnusedTree:
    """The library verifies the form of every tree, but makes only those that the main tree leads to."""

    @pytest.mark.parametrize(
        ("body", "says"),
        [
            ('<SubTree ID="Nope"/>', "there is no tree 'Nope'"),
            ('<Action ID="Removed" x="1"/>', "there is no node 'Removed'"),
            ('<AlwaysSuccess foo="1"/>', "has no port 'foo'"),
            ('<AlwaysSuccess _skipIf="true"/>', "'_skipIf'"),
            ('<LeafNodeZx200 record_name="r"/>', "needs 'subtask_name'"),
        ],
    )
    def test_that_could_not_be_made_is_a_warning(self, body: str, says: str) -> None:
        text = document('<SubTree ID="T1"/>', "<AlwaysSuccess/>", f"\n{body}")
        loaded = load(text)
        assert loaded.tick() is SUCCESS
        ((line, warning),) = loaded.warnings
        assert line == 5
        assert isinstance(warning, NotUsed) and warning.tree == "T2"
        assert says in words(warning)
        assert check(text).warnings == loaded.warnings
        with pytest.raises(TreeError, match=says):
            load(document('<SubTree ID="T1"/>', '<Action ID="T2"/>', body))

    @pytest.mark.parametrize("body", ["<Removed/>", "<Sequence/>", "<SubTree/>", "<Action/>", "", "<Inverter/>"])
    def test_of_a_broken_form_is_an_error(self, body: str) -> None:
        with pytest.raises(TreeError):
            load(document("<AlwaysSuccess/>", body))

    def test_inside_a_subtreeplus_is_ignored_too(self) -> None:
        body = '<SubTreePlus ID="T1">{}</SubTreePlus>'
        loaded = load(document(body.format('<Action ID="Removed"/>'), "<AlwaysSuccess/>"))
        assert [node.registration_name for node in loaded.nodes] == ["SubTreePlus", "AlwaysSuccess"]
        assert isinstance(loaded.warnings[0][1], InSubTreePlus)
        with pytest.raises(TreeError, match="no node 'Removed'"):
            load(document(body.format("<Removed/>"), "<AlwaysSuccess/>"))

    def test_without_a_main_tree_every_tree_counts(self) -> None:
        text = document("<AlwaysSuccess/>", '<SubTree ID="Nope"/>').replace('_execute="M"', '_execute="Q"')
        assert len(check(text).errors) == 2


class TestInclude:
    def test_included_trees_come_first(self, tmp_path: Path) -> None:
        (tmp_path / "sub").mkdir()
        (tmp_path / "sub/other.xml").write_text('<root><include path="third.xml"/></root>')
        (tmp_path / "sub/third.xml").write_text('<root><BehaviorTree ID="A"><AlwaysSuccess/></BehaviorTree></root>')
        main = tmp_path / "main.xml"
        main.write_text(
            '<root main_tree_to_execute="M"><include path="sub/other.xml"/><BehaviorTree ID="M"><SubTree ID="A"/>'
            '</BehaviorTree><BehaviorTree ID="A"><AlwaysFailure/></BehaviorTree></root>'
        )
        loaded = load(main)
        assert loaded.tick() is SUCCESS
        assert loaded.warnings == [(1, TwoTrees("A"))]

    @pytest.mark.parametrize(
        ("include", "message"),
        [
            ('path="../secret.xml"', "outside the tree's folder"),
            ('path="/etc/passwd"', "outside the tree's folder"),
            ('path="link.xml"', "outside the tree's folder"),
            ('path="nope.xml"', "cannot include 'nope.xml'"),
            ('path="loop.xml"', "includes itself"),
            ('path="x.xml" ros_pkg="p"', "ros_pkg is not supported"),
            ("", "include needs a path"),
        ],
    )
    def test_refused(self, tmp_path: Path, include: str, message: str) -> None:
        (tmp_path / "secret.xml").write_text("<root/>")
        folder = tmp_path / "tasks"
        folder.mkdir()
        (folder / "link.xml").symlink_to(tmp_path / "secret.xml")
        (folder / "loop.xml").write_text('<root><include path="loop.xml"/></root>')
        text = f"<root>\n<include {include}/></root>"
        with pytest.raises(TreeError, match=message) as caught:
            load(text, folder=folder)
        assert caught.value.line in (1, 2)

    def test_text_without_a_folder_includes_nothing(self) -> None:
        with pytest.raises(TreeError, match="comes from no folder"):
            load('<root><include path="a.xml"/></root>')


class TestVersion4:
    def text(self, body: str) -> str:
        return document(body, "<AlwaysSuccess/>").replace("<root ", '<root BTCPP_format="4" ', 1)

    def test_what_means_the_same_loads(self) -> None:
        loaded = load(self.text(
            '<SequenceWithMemory><Parallel failure_count="1"><AlwaysSuccess/></Parallel>'
            '<SubTree ID="T1" name="sub" _autoremap="true" a="{b}" c="text"/></SequenceWithMemory>'
        ))  # fmt: skip
        names = [node.registration_name for node in loaded.nodes]
        assert names == ["SequenceStar", "Parallel", "AlwaysSuccess", "SubTreePlus", "AlwaysSuccess"]
        assert loaded.nodes[3].name == "sub"
        assert loaded.tick() is SUCCESS

    @pytest.mark.parametrize(
        ("body", "feature"),
        [
            ('<AlwaysSuccess _skipIf="a"/>', "script attribute '_skipIf'"),
            ('<Script code="a:=1"/>', "<Script> is a node of BehaviorTree.CPP v4"),
            ('<Action ID="Sleep" msec="1"/>', "<Sleep> is a node of BehaviorTree.CPP v4"),
            ('<SetBlackboard value="json:{}" output_key="a"/>', "json values"),
            ('<SetBlackboard value="{@a}" output_key="a"/>', "root blackboard"),
        ],
    )
    def test_other_features_are_named(self, body: str, feature: str) -> None:
        with pytest.raises(TreeError) as caught:
            load(self.text(body))
        assert feature in words(caught.value.what)
        assert caught.value.line == 3


def test_ports_with_lists_of_one_type_share_a_key() -> None:
    class Wants(SyncAction):
        numbers: In[list[int]]

    class WantsToo(SyncAction):
        numbers: In[list[int]]

    text = document('<Sequence><Wants numbers="{k}"/><WantsToo numbers="{k}"/></Sequence>')
    assert load(text, registry=registry().extended(Wants, WantsToo)).root.name == "Sequence"
