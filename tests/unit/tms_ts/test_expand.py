"""Templates: what a call puts into a tree, by the C++ system's rules, and what is wrong with a call or a template."""

from __future__ import annotations

from xml.sax.saxutils import quoteattr

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tms_ts.bt import SUCCESS, TickError, TreeError, check, check_template, load
from tms_ts.bt.display import ascii_tree
from tms_ts.tree_reasons import (
    CallNotSeen,
    CallWithSlash,
    InTemplate,
    KeyBecomesNone,
    KeyOpen,
    KeysGiven,
    NestedCall,
    NoTemplate,
    PartWithoutColon,
    TemplateInItself,
    TemplateUnseen,
    TreeNameForCpp,
)
from unit.tms_ts.trees import document
from words import words

SWING = '<Action ID="LeafNodeZx200" model_name="$model_name$" record_name="$r$" subtask_name="st_zx200_swing"/>'
MODEL = "<TreeNodesModel/>"
text_of_xml = st.text(st.sampled_from("ab$:,\n {}<&\"'/"), max_size=20)


def template(body: str) -> str:
    return (
        '<root main_tree_to_execute="BehaviorTree">\n<!-- // -->\n<BehaviorTree ID="BehaviorTree">\n'
        f"{body}\n</BehaviorTree>\n{MODEL}</root>"
    )


def call(name: str, parameters: str = "", **more: str) -> str:
    others = "".join(f' {key}="{value}"' for key, value in more.items())
    return f'<Action ID="ExecuteSubtask"{others} subtask_name="{name}" subtask_parameters="{parameters}"/>'


def ports(body: str, **templates: str) -> list[dict[str, str]]:
    """The attributes of the leaves of a task."""
    loaded = load(document(body), templates=texts(templates).get)
    return [node.assigned() for node in loaded.nodes if not node.children]


def texts(bodies: dict[str, str]) -> dict[str, str]:
    return {name: template(body) for name, body in bodies.items()}


def value(parameters: str, wanted: str, **attributes: str) -> str:
    """What a template's attribute becomes."""
    (leaf,) = ports(call("T", parameters, **attributes), T=f'<SetBlackboard output_key="x" value="{wanted}"/>')
    return leaf["value"]


# the rules


def test_a_call_becomes_the_tree_of_its_template() -> None:
    loaded = load(
        document(f"<Sequence>{call('Dig', 'r:pose_1', model_name='zx200')}\n<AlwaysSuccess/></Sequence>"),
        templates=texts({"Dig": f"<Sequence>\n{SWING}\n<AlwaysSuccess/></Sequence>"}).get,
    )
    assert [line.strip() for line in ascii_tree(loaded).splitlines()] == [
        "{-} Sequence", "{-} Sequence",
        '--> LeafNodeZx200 model_name="zx200" record_name="pose_1" subtask_name="st_zx200_swing"',
        "--> AlwaysSuccess", "--> AlwaysSuccess",
    ]  # fmt: skip
    assert [(node.line, node.template) for node in loaded.nodes] == [
        (3, ""), (3, "Dig:4"), (3, "Dig:5"), (3, "Dig:6"), (4, ""),
    ]  # fmt: skip
    assert list(loaded.templates) == ["Dig"]
    (goal,) = loaded.leaf_goals()
    assert (goal.machine, goal.record, goal.line, goal.template) == ("zx200", "pose_1", 3, "Dig:5")


def test_a_template_may_be_the_whole_task_and_be_called_twice() -> None:
    assert ports(call("T", "a:1"), T='<SetBlackboard output_key="x" value="$a$"/>')[0]["value"] == "1"
    two = f"<Sequence>{call('T', 'a:1')}{call('T', 'a:2')}</Sequence>"
    assert [leaf["value"] for leaf in ports(two, T='<SetBlackboard output_key="x" value="$a$"/>')] == ["1", "2"]


@pytest.mark.parametrize(
    ("parameters", "attributes", "wanted", "becomes"),
    [
        ("a:1,b:2", {}, "$a$/$b$/$a$", "1/2/1"),
        ("a:1:2", {}, "$a$", "1:2"),  # the first colon counts
        ("a: 1 , b:2", {}, "[$a$][$ b$]", "[ 1 ][2]"),  # blanks count
        ("a:1,junk,b:2", {}, "$a$$b$", "12"),  # a part without a colon does not
        ("a:", {}, "[$a$]", "[]"),  # an empty value
        ("", {"a": "1", "machine_record_name": "R"}, "$a$ $machine_record_name$", "1 R"),
        ("a:1", {"a": "2"}, "$a$", "1"),  # parameters win
        ("b:$c$,c:3", {}, "$b$", "3"),  # c comes after b
        ("b:2,a:x", {}, "$a$b$", "xb$"),  # a before b
        ("b:2", {}, "$b$c$", "2c$"),
        ("a:1", {}, "$a $ $ a$ 5$ $", "$a $ $ a$ 5$ $"),  # no keys
    ],
)
def test_how_keys_are_filled_in(parameters: str, attributes: dict[str, str], wanted: str, becomes: str) -> None:
    assert value(parameters, wanted, **attributes) == becomes


@pytest.mark.parametrize("key", ["ID", "subtask_name", "subtask_parameters"])
def test_what_a_call_itself_needs_is_no_key(key: str) -> None:
    with pytest.raises(TreeError) as caught:
        value(f"{key}:1", f"${key}$")
    assert caught.value.what == KeyOpen(key)


def test_a_part_without_a_colon_gives_no_value() -> None:
    with pytest.raises(TreeError, match=r"\$b\$ has no value"):
        value("a:1,b", "$b$")


def test_keys_stand_in_every_attribute() -> None:
    known = texts({"T": '<Action ID="$node$" name="$n$"/>'}).get
    loaded = load(document(call("T", "node:AlwaysFailure,n:first")), templates=known)
    assert (loaded.root.registration_name, loaded.root.name) == ("AlwaysFailure", "first")


def test_the_blackboard_is_that_of_the_caller() -> None:
    body = f'<Sequence>{call("Set")}<BlackboardCheckInt value_A="{{n}}" value_B="4" return_on_mismatch="FAILURE">'
    body += "<AlwaysSuccess/></BlackboardCheckInt></Sequence>"
    loaded = load(document(body), templates=texts({"Set": '<SetBlackboard output_key="n" value="4"/>'}).get)
    assert loaded.tick() is SUCCESS


def test_a_number_is_one_only_after_the_call() -> None:
    delay = '<Delay delay_msec="$time$"><AlwaysSuccess/></Delay>'
    assert not check(document(call("T", "time:5000")), templates=texts({"T": delay}).get).warnings
    report = check(document(call("T", "time:soon")), templates=texts({"T": delay}).get)
    ((line, warning),) = report.warnings
    assert line == 3
    assert isinstance(warning, InTemplate)
    assert words(warning) == "in template T:4: delay_msec='soon' of Delay is not of type unsigned int"


def test_line_breaks_in_attributes_stay() -> None:
    body = f"<Sequence name='one\ntwo'>{call('T')}</Sequence>"
    loaded = load(document(body), templates=texts({"T": "<AlwaysSuccess name='three\nfour'/>"}).get)
    assert [node.name for node in loaded.nodes] == ["one\ntwo", "three\nfour"]
    private = "\ue000 \ue001 "  # what stands for breaks while the task is read
    loaded = load(document(body), templates=texts({"T": f"<AlwaysSuccess name='{private}'/>"}).get)
    assert [node.name for node in loaded.nodes] == ["one\ntwo", private]


def test_a_call_in_the_palette_or_in_a_comment_is_none() -> None:
    model = '<TreeNodesModel><Action ID="ExecuteSubtask"><input_port name="x"/></Action></TreeNodesModel>'
    loaded = load(document(f"<!-- {call('No').replace('--', '')} --><AlwaysSuccess/>", model=model))
    assert len(loaded.nodes) == 1


def test_leaves_that_only_the_palette_of_a_template_knows() -> None:
    names = "".join(f'<input_port name="{port}"/>' for port in ("model_name", "record_name", "subtask_name"))
    text = template(SWING.replace("Zx200", "New")).replace(
        MODEL, f'<TreeNodesModel><Action ID="LeafNodeNew">{names}</Action></TreeNodesModel>'
    )
    loaded = load(document(call("T", "r:1", model_name="zx200")), templates={"T": text}.get)
    assert loaded.leaf_goals()[0].record == "1"


# templates that call templates


def test_templates_call_templates_and_the_cpp_system_cannot() -> None:
    loaded = load(
        document(call("Outer", "a:7")),
        templates=texts({
            "Outer": f"<Sequence>\n{call('Inner', 'b:$a$')}</Sequence>",
            "Inner": '<SetBlackboard output_key="x" value="$b$"/>',
        }).get,
    )  # fmt: skip
    assert loaded.nodes[1].assigned()["value"] == "7"
    assert loaded.nodes[1].template == "Outer:5 > Inner:4"
    assert loaded.warnings == [(3, InTemplate("Outer:5", NestedCall("Inner")))]
    assert sorted(loaded.templates) == ["Inner", "Outer"]


def test_a_circle_is_refused_with_its_path() -> None:
    calls = texts({"A": call("B"), "B": f"<Sequence>{call('C')}</Sequence>", "C": f"\n{call('B')}"})
    with pytest.raises(TreeError) as caught:
        load(document(call("A")), templates=calls.get)
    assert caught.value.what == TemplateInItself("B", "B -> C -> B")
    assert (caught.value.line, caught.value.template) == (3, "A:4 > B:4 > C:5")
    assert str(caught.value) == ("line 3: in template A:4 > B:4 > C:5: the template 'B' calls itself (B -> C -> B)")


def test_an_endless_family_of_templates_is_refused() -> None:
    chain = lambda name: template(call(f"{name}x"))  # noqa: E731
    with pytest.raises(TreeError, match="more than 50 templates call each other"):
        load(document(call("x")), templates=chain)
    wide = {f"T{n}": template(f"<Sequence>{call(f'T{n + 1}') * 10}</Sequence>") for n in range(8)}
    with pytest.raises(TreeError, match="more than 20000 nodes"):
        load(document(call("T0")), templates={**wide, "T8": template("<AlwaysSuccess/>")}.get)


def test_templates_that_together_are_too_deep() -> None:
    deep = {f"T{n}": template("<Inverter>" * 90 + call(f"T{n + 1}") + "</Inverter>" * 90) for n in range(3)}
    with pytest.raises(TreeError, match="nested deeper than 200"):
        load(document(call("T0")), templates={**deep, "T3": template("<AlwaysSuccess/>")}.get)


def test_a_value_that_grows_without_end_is_refused() -> None:
    doubling = ",".join(f"{chr(97 + n)}:${chr(98 + n)}$${chr(98 + n)}$" for n in range(25))
    with pytest.raises(TreeError, match="the value of value has more than 100000 letters"):
        value(f"{doubling},z:zzzz", "$a$")


# what is wrong


def wrong(body: str, **templates: str) -> tuple[int | None, str]:
    with pytest.raises(TreeError) as caught:
        load(document(body), templates=templates.get)
    assert str(check(document(body), templates=templates.get).errors[0]) == str(caught.value)
    return caught.value.line, words(caught.value.reason)


def test_a_template_that_nobody_has() -> None:
    report = check(document(f"<Sequence>\n{call('Gone')}</Sequence>"))
    (error,) = report.errors
    assert error.what == NoTemplate("Gone")
    assert str(error) == "line 4: there is no template 'Gone'"


def test_a_key_without_a_value() -> None:
    (error,) = check(document(call("T", "a:1")), templates=texts({"T": f"\n{SWING.replace('$r$', '$a$')}"}).get).errors
    assert (error.what, error.hint, error.template) == (KeyOpen("model_name"), KeysGiven(("$a$",), "model_name"), "T:5")
    hint = "the call gives $a$; model_name:none says that there is none"
    assert str(error) == f"line 3: in template T:5: $model_name$ has no value ({hint})"


def test_the_cpp_system_writes_none() -> None:
    report = check(document(call("T", "r:1")), templates=texts({"T": SWING}).get, cpp=True)
    assert report.ok
    assert (3, InTemplate("T:4", KeyBecomesNone("model_name"))) in report.warnings
    assert report.goals[0].machine == "none"


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("<root>", "line 1: not well-formed"),
        ("", "the task is empty"),
        ("<tree/>", "line 1: the outermost element of a template is <root>, here it is <tree>"),
        ("<root>\n</root>", "line 1: a template has exactly one <BehaviorTree>, here are 0"),
        (template("<AlwaysSuccess/>").replace("</root>", "<BehaviorTree/></root>"), "here are 2"),
        (template(""), "line 3: the tree of a template has exactly one node at its top, here are 0"),
        (template("<AlwaysSuccess/><AlwaysSuccess/>"), "here are 2"),
        (template("<AlwaysSuccess/>").replace("<root", '<root BTCPP_format="4"'), "form of BehaviorTree.CPP v3"),
        (template("<AlwaysSuccess/>").replace(MODEL, '<include path="a.xml"/>'), "line 6: a template includes no"),
    ],
)
def test_a_template_that_is_none(text: str, says: str) -> None:
    line, reason = wrong(f"<Sequence>\n{call('T')}</Sequence>", T=text)
    assert line == 4
    assert reason.startswith("line 4: template 'T' cannot be used: ") and says in reason


@pytest.mark.parametrize(
    ("body", "line", "says"),
    [
        ("<Sequense><AlwaysSuccess/></Sequense>", 4, "there is no node 'Sequense'"),
        ("\n<AlwaysSuccess x='1'/>", 5, "AlwaysSuccess has no port 'x', possibly a typo"),
        ("<Sequence/>", 4, "Sequence needs at least one child"),
        ('<SubTree ID="Gone"/>', 4, "there is no tree 'Gone'"),
        ("<IfThenElse><AlwaysSuccess/></IfThenElse>", 4, "IfThenElse must have 2 or 3 children, it has 1"),
    ],
)
def test_what_is_wrong_inside_a_template(body: str, line: int, says: str) -> None:
    (error,) = check(document(call("T")), templates=texts({"T": body}).get).errors
    assert error.line == 3
    assert f"in template T:{line}: {says}" in str(error)


def test_what_a_node_of_a_template_throws_while_it_runs() -> None:
    loaded = load(document(call("T")), templates=texts({"T": '\n<SetBlackboard value="1"/>'}).get)
    with pytest.raises(TickError) as caught:
        loaded.tick()
    assert (caught.value.line, caught.value.path, caught.value.template) == (3, "0", "T:5")
    assert str(caught.value).startswith("line 3, at 0: in template T:5: SetBlackboard: ")


@given(text_of_xml, text_of_xml, text_of_xml)
def test_no_call_and_no_template_breaks_the_check(parameters: str, attribute: str, body: str) -> None:
    asks = f"<Action ID='ExecuteSubtask' subtask_name='T' a={quoteattr(attribute)} subtask_parameters="
    text = template(f"<AlwaysSuccess name={quoteattr(body)}/>")
    report = check(document(f"{asks}{quoteattr(parameters)}/>"), templates={"T": text}.get)
    assert all(isinstance(error.what, KeyOpen) for error in report.errors)
    cpp = check(document(f"{asks}{quoteattr(parameters)}/>"), templates={"T": text}.get, cpp=True)
    assert cpp.ok and cpp.nodes == 1


@pytest.mark.parametrize(
    ("body", "says"),
    [
        ('<Action ID="ExecuteSubtask"/>', "ExecuteSubtask needs 'subtask_name'"),
        ('<Action ID="ExecuteSubtask" subtask_name="T"><AlwaysSuccess/></Action>', "ExecuteSubtask has no children"),
    ],
)
def test_a_call_that_is_none(body: str, says: str) -> None:
    assert wrong(body, T=template("<AlwaysSuccess/>")) == (3, f"line 3: {says}")


def test_a_call_in_a_v4_document() -> None:
    text = document('<ExecuteSubtask subtask_name="T"/>').replace("<root", '<root BTCPP_format="4"')
    with pytest.raises(TreeError, match=r"for documents of BehaviorTree.CPP v3"):
        load(text, templates=texts({"T": "<AlwaysSuccess/>"}).get)


def test_errors_are_told_up_to_a_limit() -> None:
    asked: list[str] = []
    calls = "".join(call(f"T{n}") for n in range(300))
    report = check(document(f"<Sequence>{calls}</Sequence>"), templates=asked.append)
    assert len(report.errors) == len(asked) == 100


def test_where_the_cpp_system_sees_no_call() -> None:
    found = texts({"T": "<AlwaysSuccess/>"}).get
    assert load(document('<Action subtask_name="T" ID="ExecuteSubtask"/>'), templates=found).warnings == [
        (3, CallNotSeen())
    ]
    assert load(document('<ExecuteSubtask subtask_name="T"/>'), templates=found).warnings == [(3, CallNotSeen())]
    slashed = load(document(call("T", machine_record_name="a/b")), templates=found).warnings
    assert slashed == [(3, CallWithSlash("machine_record_name", "a/b"))]
    assert load(document(call("T", "a:1,b")), templates=found).warnings == [(3, PartWithoutColon("b"))]


def test_where_nobody_can_be_asked_the_rest_is_checked() -> None:
    report = check(document(f"<Sequence>{call('T')}<Sequense/></Sequence>"), templates=None)
    assert report.warnings == [(3, TemplateUnseen("T"))]
    assert [words(error.what) for error in report.errors] == ["there is no node 'Sequense'"]


def test_a_run_is_not_made_without_templates() -> None:
    with pytest.raises(TreeError, match="there is no template 'T'"):
        load(document(call("T")))


# the check of a template by itself


def test_a_template_tells_its_keys() -> None:
    report = check_template("T", template(f"<Sequence>{SWING}{SWING}</Sequence>"), {}.get)
    assert (report.errors, report.warnings, report.keys) == ([], [], ["model_name", "r"])


def test_what_is_wrong_in_a_template_has_its_own_line() -> None:
    (error,) = check_template("T", template("\n<Sequense/>"), {}.get).errors
    assert (error.line, error.template) == (5, "")
    (error,) = check_template("T", "<root>\n<a></root>", {}.get).errors
    assert error.line == 2
    (error,) = check_template("T", "<root/>", {}.get).errors
    assert error.line == 1


def test_what_a_template_calls_is_looked_at() -> None:
    inner = texts({"B": f"\n{SWING}", "C": call("A")})
    report = check_template("A", template(call("B", "r:$x$", model_name="$m$")), inner.get)
    assert (report.errors, report.keys) == ([], ["m", "x"])
    assert report.warnings == [(4, NestedCall("B"))]
    (error,) = check_template("A", template(call("B", "r:$x$")), inner.get).errors
    assert (error.what, error.line, error.template) == (KeyOpen("model_name"), 4, "B:5")
    (error,) = check_template("A", template(call("C")), inner.get).errors
    assert error.what == TemplateInItself("A", "A -> C -> A")


def test_a_template_that_the_cpp_system_cannot_cut_out() -> None:
    named = template("<AlwaysSuccess/>").replace('ID="BehaviorTree"', 'ID="Dig"')
    for text in (named, template("<AlwaysSuccess/>").replace(MODEL, "")):
        report = check_template("T", text, {}.get)
        assert (1, TreeNameForCpp()) in report.warnings
