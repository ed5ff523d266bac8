"""The nodes of version 6 of the C++ system that read, write, search, calculate and wait."""

from __future__ import annotations

from typing import Any, ClassVar

import pytest

from tms_reason.reason import Reason
from tms_ts import tree_reasons as r
from tms_ts.bt import FAILURE, RUNNING, SUCCESS, Status, TickError, Tree, check
from tms_ts.nodes.calculation import calculate
from tms_ts.nodes.expression import Invalid, evaluate, names
from unit.tms_ts.fakes import FakeFlags, FakeWorld
from unit.tms_ts.trees import document, ticked, tree


def stored(one: Tree) -> dict[str, Any]:
    return dict(one.blackboards[0].items())


def notes(body: str, **stored: str) -> list[Reason]:
    """What the check before a run says of a tree whose keys get these texts before."""
    texts = "".join(f'<SetBlackboard value="{value}" output_key="{key}"/>' for key, value in stored.items())
    report = check(document(f"<Sequence>{texts}{body}</Sequence>" if stored else body))
    assert report.ok
    return [what for _, what in report.warnings]


class TestMongoValueReader:
    body = '<MongoValueReader mongo_record_name="rec" mongo_param_name="f" output_port="{}"/>'

    @pytest.mark.parametrize("value", ["a", True, 3, 2.5, 2**40])
    def test_the_port_names_the_key(self, value: Any) -> None:
        one = tree(self.body.format("k"), fake=FakeWorld(flags=FakeFlags({("rec", "f"): value})))
        assert one.tick() is SUCCESS
        assert stored(one) == {"k": value}

    def test_braces_name_the_key_that_a_value_names(self) -> None:
        fake = FakeWorld(flags=FakeFlags({("rec", "f"): "a"}))
        one = tree(self.body.format("{x}"), fake=fake, blackboard={"x": "k"})
        assert one.tick() is SUCCESS
        assert stored(one) == {"x": "k", "k": "a"}

    @pytest.mark.parametrize("value", [None, [1], {"a": 1}])
    def test_what_is_no_plain_value_fails(self, value: Any) -> None:
        assert tree(self.body.format("k"), fake=FakeWorld(flags=FakeFlags({("rec", "f"): value}))).tick() is FAILURE

    def test_a_missing_record_fails(self) -> None:
        assert tree(self.body.format("k"), fake=FakeWorld(flags=FakeFlags(missing={"rec"}))).tick() is FAILURE


class TestMongoValueWriter:
    def write(self, ports: str, **blackboard: Any) -> tuple[Status, Any]:
        fake = FakeWorld()
        one = tree(f'<MongoValueWriter mongo_record_name="rec" mongo_param_name="f" {ports}/>', fake=fake,
                   blackboard=blackboard)  # fmt: skip
        status, why = ticked(one)
        assert (why is None) is (status is SUCCESS)
        return status, fake.flags.values.get(("rec", "f"))

    @pytest.mark.parametrize(
        ("text", "value"),
        [("&quot;3725960300000&quot;", "3725960300000"), ("&quot;true&quot;", "true"), ("&quot;&quot;", ""),
         ("&quot;", '"'), ("true", True), ("12", 12), ("3.7", 3.7), ("12ab", 12), ("3725960300000", 3725960300000.0),
         ("up", "up"), ("a.b", "a.b"), ("", ""), ("\\\\", "\\\\")],
    )  # fmt: skip
    def test_a_literal_without_a_type(self, text: str, value: Any) -> None:
        status, written = self.write(f'input_value="{text}" input_type=""')
        assert (status, written, type(written)) == (SUCCESS, value, type(value))

    @pytest.mark.parametrize(
        ("type_", "text", "value"),
        [("int", "3", 3), ("int", "3.7", 3), ("double", "3", 3.0), ("bool", "true", True), ("string", "3", "3"),
         ("string", "true", "true"), ("string", "&quot;a&quot;", "a"), ("string", "LATEST", "LATEST")],
    )  # fmt: skip
    def test_a_type_decides(self, type_: str, text: str, value: Any) -> None:
        status, written = self.write(f'input_value="{text}" input_type="{type_}"')
        assert (status, written, type(written)) == (SUCCESS, value, type(value))

    @pytest.mark.parametrize(
        ("type_", "text"),
        [("int", "up"), ("double", "true"), ("bool", "1"), ("bool", "up"), ("float", "3"), ("Int", "3")],
    )
    def test_what_is_not_of_the_type_fails(self, type_: str, text: str) -> None:
        ports = f'input_value="{text}" input_type="{type_}"'
        assert self.write(ports) == (FAILURE, None)
        (note,) = notes(f'<MongoValueWriter mongo_record_name="rec" mongo_param_name="f" {ports}/>')
        assert isinstance(note, r.AlwaysFails)

    @pytest.mark.parametrize(
        ("stored", "type_", "value"),
        [("3725960300000", "", "3725960300000"), ("true", "", True), (True, "", True), (5, "", 5), (2.5, "", 2.5),
         (5, "double", 5.0), ("5", "int", 5), (5, "string", "5"), (False, "string", "false"), (2.0, "int", 2)],
    )  # fmt: skip
    def test_a_key(self, stored: Any, type_: str, value: Any) -> None:
        status, written = self.write(f'input_value="\\k\\" input_type="{type_}"', k=stored)
        assert (status, written, type(written)) == (SUCCESS, value, type(value))

    @pytest.mark.parametrize(
        ("stored", "type_"), [({}, ""), ({"k": "up"}, "int"), ({"k": 2.5}, "int"), ({"k": 1}, "bool")]
    )
    def test_a_key_without_such_a_value_fails(self, stored: dict[str, Any], type_: str) -> None:
        assert self.write(f'input_value="\\k\\" input_type="{type_}"', **stored) == (FAILURE, None)

    def test_a_missing_record_fails(self) -> None:
        one = tree('<MongoValueWriter mongo_record_name="rec" mongo_param_name="f" input_value="1"/>',
                   fake=FakeWorld(flags=FakeFlags(missing={"rec"})))  # fmt: skip
        assert one.tick() is FAILURE

    @pytest.mark.parametrize(
        ("ports", "said"),
        [('input_value="3.7"', [r.WholeWritten("3.7", "3")]),
         ('input_value="12ab"', [r.BeginningWritten("12ab", "12")]),
         ('input_value="3.7" input_type="double"', []), ('input_value="3.0"', []), ('input_value="12"', []),
         ('input_value="&quot;12ab&quot;"', []), ('input_value="\\k\\"', []), ('input_value="{k}"', [])],
    )  # fmt: skip
    def test_the_check_tells_what_is_lost(self, ports: str, said: list[Reason]) -> None:
        assert notes(f'<MongoValueWriter mongo_record_name="rec" mongo_param_name="f" {ports}/>', k="up") == said


class TestMongoArrayWriter:
    body = '<MongoArrayWriter mongo_record_name="rec" mongo_param_name="f" input_value="{}" operation="{}"/>'

    @pytest.mark.parametrize(
        ("before", "value", "operation", "after"),
        [(["a"], "b", "add", ["a", "b"]), (["a"], "a", "add", ["a"]), (["a"], "a", "push", ["a", "a"]),
         (["a", "b", "a"], "a", "remove", ["b"]), (["a"], "b", "remove", ["a"]), (["a"], "", "reset", []),
         (["a"], "\\none\\", "reset", []),
         ([1], "2", "add", [1, 2]), (["a"], "\\k\\", "add", ["a", "here"]), ([], "&quot;1&quot;", "push", ["1"])],
    )  # fmt: skip
    def test_changes(self, before: list[Any], value: str, operation: str, after: list[Any]) -> None:
        fake = FakeWorld(flags=FakeFlags({("rec", "f"): before}))
        one = tree(self.body.format(value, operation), fake=fake, blackboard={"k": "here"})
        assert one.tick() is SUCCESS
        assert fake.flags.values["rec", "f"] == after

    @pytest.mark.parametrize(
        ("value", "operation", "before", "missing"),
        [("a", "insert", ["a"], set()), ("\\none\\", "add", ["a"], set()), ("a", "add", "text", set()),
         ("a", "add", ["a"], {"rec"})],
    )  # fmt: skip
    def test_failures(self, value: str, operation: str, before: Any, missing: set[str]) -> None:
        fake = FakeWorld(flags=FakeFlags({("rec", "f"): before}, missing=missing))
        one = tree(self.body.format(value, operation), fake=fake)
        status, why = ticked(one)
        assert (status, why is None) == (FAILURE, False)
        assert fake.flags.values["rec", "f"] == before

    def test_the_check_names_an_unknown_operation(self) -> None:
        assert notes(self.body.format("a", "insert")) == [r.AlwaysFails(r.NoOperation("insert"), "MongoArrayWriter")]
        assert notes(self.body.format("a", "add")) == []

    def test_missing_ports_are_told(self) -> None:
        assert notes("<MongoArrayWriter/>") == [
            r.ThrowsWithoutPort("MongoArrayWriter", port)
            for port in ("mongo_record_name", "mongo_param_name", "operation")
        ]
        with pytest.raises(TickError):
            tree("<MongoArrayWriter/>").tick()

    def test_it_counts_as_a_writer_of_its_record(self) -> None:
        (value,) = tree(self.body.format("a", "add")).shared_values()
        assert (value.record, value.field, value.writes) == ("rec", "f", True)


SECTIONS = {("truck", "CURRENT_SECTION"): "12", ("truck", "UP_DOWN"): "up", ("truck", "n"): 3, ("bull", "ready"): True}


class TestMongoValueSearcher:
    body = '<{} mongo_param_name="{}" mongo_value="{}" output_port="{}"/>'

    def search(self, fields: str, values: str, output: str = "k", name: str = "MongoValueSearcher") -> Tree:
        fake = FakeWorld(flags=FakeFlags(dict(SECTIONS)))
        keys = {"here": "12", "way": "up", "yes": True, "n": 3}
        return tree(self.body.format(name, fields, values, output), fake=fake, blackboard=keys)

    @pytest.mark.parametrize(
        ("fields", "values", "found"),
        [("CURRENT_SECTION", "\\here\\", True), ("CURRENT_SECTION,UP_DOWN", "=\\here\\,\\way\\", True),
         ("CURRENT_SECTION,UP_DOWN", "\\here\\,down", False), ("CURRENT_SECTION", "&quot;12&quot;", True),
         ("CURRENT_SECTION", "12", False), ("n", "3", True), ("n", "\\n\\", True), ("n", "3.0", True),
         ("ready", "true", True), ("ready", "\\yes\\", True), ("ready", "1", False), ("UP_DOWN", "up", True)],
    )  # fmt: skip
    @pytest.mark.parametrize("output", ["k", "{k}"])
    def test_the_key_gets_whether_there_is_such_a_record(
        self, fields: str, values: str, found: bool, output: str
    ) -> None:
        one = self.search(fields, values, output)
        assert one.tick() is SUCCESS
        assert stored(one)["k"] is found

    def test_lists_of_other_lengths_fail(self) -> None:
        assert self.search("a,b", "1").tick() is FAILURE
        assert notes(self.body.format("MongoValueSearcher", "a,b", "1", "k")) == [
            r.AlwaysFails(r.UnevenLists(2, 1), "MongoValueSearcher")
        ]

    def test_a_key_without_a_value_fails(self) -> None:
        one = self.search("CURRENT_SECTION", "\\none\\")
        assert ticked(one) == (FAILURE, r.KeyHasNoValue("none"))

    def test_nowhere_to_write(self) -> None:
        body = '<MongoValueSearcher mongo_param_name="a" mongo_value="1"/>'
        with pytest.raises(TickError):
            tree(body).tick()
        assert notes(body) == [r.ThrowsWithoutPort("MongoValueSearcher", "output_port")]

    def test_it_waits_for_the_answer(self) -> None:
        fake = FakeWorld(flags=FakeFlags(dict(SECTIONS), slow=True))
        one = tree(self.body.format("MongoValueSearcher", "n", "3", "k"), fake=fake)
        assert [one.tick(), one.tick()] == [RUNNING, RUNNING]
        fake.flags.answer_all()
        assert one.tick() is SUCCESS
        assert len(fake.flags.searches) == 1

    @pytest.mark.parametrize(
        ("values", "wanted"), [("{here},{way}", ["A", "up"]), ("{yes}", [True]), ("{n},1", [3, 1])]
    )
    def test_the_early_form_has_keys_in_braces(self, values: str, wanted: list[Any]) -> None:
        fake = FakeWorld(flags=FakeFlags(dict(SECTIONS)))
        fields = ",".join("ab"[: len(wanted)])
        body = self.body.format("BlackboardValueSearcherMongo", fields, values, "k")
        keys = {"here": "A", "way": "up", "yes": "true", "n": "3"}
        stores = "".join(f'<SetLocalBlackboard value="{keys[key]}" output_key="{key}"/>' for key in keys)
        one = tree(f"<Sequence>{stores}{body}</Sequence>", fake=fake)
        assert one.tick() is SUCCESS
        assert fake.flags.searches == [dict(zip("ab", wanted, strict=False))]
        assert fake.flags.searches[0]["a"] is wanted[0] or not isinstance(wanted[0], bool)

    def test_the_check_tells_of_braces_at_both_ends(self) -> None:
        body = self.body.format("BlackboardValueSearcherMongo", "a,b", "{x},{y}", "k")
        assert notes(body, x="1", y="2") == [r.AllBraces("mongo_value", "{x},{y}")]


class TestKeepRunningUntilFlgup:
    body = '<KeepRunningUntilFlgup key="k" while_or_dowhile="{}">{}</KeepRunningUntilFlgup>'
    child = '<MongoValueWriter mongo_record_name="rec" mongo_param_name="f" input_value="1"/>'
    sets = '<SetLocalBlackboard value="true" output_key="k"/>'

    @pytest.mark.parametrize(
        ("mode", "runs"), [("While", 0), ("while", 0), ("", 1), ("DoWhile", 1), ("dowhile", 1), ("WHILE", 1)]
    )
    def test_a_flag_that_is_up_before(self, mode: str, runs: int) -> None:
        fake = FakeWorld()
        assert tree(self.body.format(mode, self.child), fake=fake, blackboard={"k": True}).tick() is SUCCESS
        assert len(fake.flags.writes) == runs

    @pytest.mark.parametrize("mode", ["while", ""])
    def test_a_flag_that_the_child_puts_up_counts_at_once(self, mode: str) -> None:
        assert tree(self.body.format(mode, self.sets)).tick() is SUCCESS

    @pytest.mark.parametrize("mode", ["while", ""])
    def test_child(self, mode: str) -> None:
        assert tree(self.body.format(mode, "<AlwaysFailure/>"), blackboard={"k": False}).tick() is FAILURE
        assert tree(self.body.format(mode, "<AlwaysSuccess/>"), blackboard={"k": False}).tick() is RUNNING

    def test_a_flag_that_comes_from_outside_ends_a_running_child(self) -> None:
        one = tree(self.body.format("while", '<WaitTimer seconds="9"/>'), blackboard={"k": False})
        assert one.tick() is RUNNING
        one.blackboards[0].set("k", True)
        assert one.tick() is SUCCESS
        assert not one.running()

    def test_no_flag(self) -> None:
        with pytest.raises(TickError, match="not true or false"):
            tree(self.body.format("while", "<AlwaysSuccess/>"), blackboard={"k": "up"}).tick()

    def test_the_check_tells_of_a_round_too_many(self) -> None:
        first = self.sets.replace("true", "false")
        assert notes(self.body.format("", self.sets)) == [r.OneRoundMore("k")]
        assert notes(f"<Sequence>{first}{self.body.format('', self.sets)}</Sequence>") == []
        assert notes(self.body.format("while", self.sets)) == []
        assert notes(self.body.format("", self.sets).replace(' while_or_dowhile=""', "")) == []  # of version 5


class TestCalculator:
    body = '<LocalBlackboardCaluculator calculation_formula="{}" output_key="{}"/>'

    @pytest.mark.parametrize(
        ("formula", "result"),
        [("1 + 2 * 3", 7.0), ("({n} + 1) * 2.5", 10.0), ("-{n}", -3.0), ("+1 - -2", 3.0), ("{half}/{n}", 0.5 / 3),
         ("{n}", 3.0), ("{n} + {half}", 3.5), ("{counter} + 1", 5.0), ("007 + .5", 7.5), ("{text}", 6.0),
         ("{half}", 0.5), ("1\n+ 1", 2.0), ("{odd name} * 2", 4.0)],
    )  # fmt: skip
    def test_result_is_a_decimal_number(self, formula: str, result: float) -> None:
        keys = {"n": "3", "half": "0.5", "text": "1 + 5", "odd name": "2"}
        stores = "".join(f'<SetLocalBlackboard value="{keys[key]}" output_key="{key}"/>' for key in keys)
        count = '<SetLocalBlackboard value="&quot;3&quot;" output_key="counter"/><Counter key="counter"/>'
        one = tree(f"<Sequence>{stores}{count}{self.body.format(formula, 'out')}</Sequence>")
        assert one.tick() is SUCCESS
        assert stored(one)["out"] == result
        assert isinstance(stored(one)["out"], float)

    @pytest.mark.parametrize(
        ("formula", "why"),
        [("1 / 0", r.DividesByZero()), ("1 / ({n} - 3)", r.DividesByZero()), ("{none} + 1", r.HoldsNoNumber("none")),
         ("{yes} + 1", r.HoldsNoNumber("yes")), ("{name} + 1", r.HoldsNoNumber("name")),
         ("{big} * {big}", r.ResultTooLarge()), ("2 ** 3", r.FormulaUnreadable()), ("7 // 2", r.FormulaUnreadable()),
         ("7 * * 2", r.FormulaUnreadable()), ("1 +", r.FormulaUnreadable()), ("", r.FormulaUnreadable()),
         ("1(2)", r.FormulaUnreadable()), ("()", r.FormulaUnreadable()), ("{n}{n}", r.FormulaUnreadable()),
         ("{n} + {n}0" + " + {n}" * 9, r.FormulaUnreadable()),
         ("2 {n}", r.FormulaUnreadable()), ("x + 1", r.FormulaUnreadable()), ("1e3", r.FormulaUnreadable()),
         ("1, 2", r.FormulaUnreadable()), ("1.2.3", r.FormulaUnreadable()), ("1+" * 99 + "1", r.ExpressionTooLong())],
    )  # fmt: skip
    def test_what_has_no_result_fails(self, formula: str, why: Reason) -> None:
        keys = {"n": 3, "yes": True, "name": "up", "big": 1e300}
        one = tree(self.body.format(formula, "out"), blackboard=keys)
        assert ticked(one) == (FAILURE, why)
        assert "out" not in stored(one)

    def test_a_key_of_another_type_is_told_before(self) -> None:
        body = '<Sequence><SetLocalBlackboard value="2" output_key="n"/>{}</Sequence>'.format(
            self.body.format("1", "n")
        )
        assert [type(one) for one in notes(body)] == [r.KeyOfTwoTypes]
        one = tree(body)
        assert one.tick() is SUCCESS
        assert stored(one) == {"n": 1.0}

    def test_the_check_tells_where_the_cpp_system_throws(self) -> None:
        assert notes(self.body.format("{a} + {b}", "k"), a="1", b="2") == [
            r.AllBraces("calculation_formula", "{a} + {b}")
        ]
        assert notes(self.body.format("({a} + {b})", "k"), a="1", b="2") == []
        assert notes(self.body.format("{a}", "k"), a="1") == []
        assert notes(self.body.format("1 +", "k")) == [
            r.AlwaysFails(r.FormulaUnreadable(), "LocalBlackboardCaluculator")
        ]

    def test_ports_that_are_missing(self) -> None:
        for body in (
            '<LocalBlackboardCaluculator output_key="k"/>',
            '<LocalBlackboardCaluculator calculation_formula="1"/>',
        ):
            with pytest.raises(TickError, match="missing parameter"):
                tree(body).tick()

    def test_calculate(self) -> None:
        assert calculate("{a}", {"a": 2.0}.__getitem__) == 2.0
        with pytest.raises(Invalid):
            calculate("__import__('os')", float)


class TestWaitTimer:
    def test_it_waits_by_the_clock(self) -> None:
        fake = FakeWorld()
        one = tree('<WaitTimer seconds="30"/>', fake=fake)
        assert one.tick() is RUNNING
        assert one.root.reason == r.Waits(30.0)
        fake.clock.now = 29.9
        assert one.tick() is RUNNING
        fake.clock.now = 30.0
        assert one.tick() is SUCCESS

    def test_a_second_by_itself(self) -> None:
        fake = FakeWorld()
        one = tree("<WaitTimer/>", fake=fake)
        one.tick()
        fake.clock.now = 1.0
        assert one.tick() is SUCCESS

    def test_a_halt_ends_the_wait(self) -> None:
        fake = FakeWorld()
        one = tree('<WaitTimer seconds="10"/>', fake=fake)
        one.tick()
        fake.clock.now = 8.0
        one.halt()
        assert one.tick() is RUNNING
        fake.clock.now = 17.9
        assert one.tick() is RUNNING
        fake.clock.now = 18.0
        assert one.tick() is SUCCESS

    def test_seconds_that_are_no_number(self) -> None:
        with pytest.raises(TickError):
            tree('<WaitTimer seconds="soon"/>').tick()


class TestQuotes:
    keys: ClassVar[dict[str, Any]] = {"way": "up", "n": 5, "count": "5", "empty": "", "yes": True, "up": "down"}

    @pytest.mark.parametrize(
        ("text", "result"),
        [('way == "up"', True), ('way=="up" and n==5', True), ('"a b" == "a b"', True), ('"up" != "none"', True),
         ('empty == ""', True), ('way != ""', True), ('none == ""', True), ('(way == "down") or (way == "up")', True),
         ('way == "(up) and 1x"', False), ('way == "上り"', False), ('"true" == yes', True), ('n == "5"', True),
         ('n == "6"', False), ('n != "5"', False), ('count == "5"', True), ('n > "4.5"', True),
         ('"up"==way', True), ('"5"=="5.0"', False)],
    )  # fmt: skip
    def test_value(self, text: str, result: bool) -> None:
        assert evaluate(text, lambda key: self.keys.get(key, "")) is result

    @pytest.mark.parametrize(
        "text", ['way == "up', 'way "up"', '"up""up" == way', 'way == "up" "up"', 'n == "up"', 'n == ""',
                 'yes == "up"', '"a" < "b"',
                 'way("up")', '5"x"', "way == 'up'", "count == 5", 'f"a" == way', '"up"']
    )  # fmt: skip
    def test_invalid(self, text: str) -> None:
        with pytest.raises(Invalid):
            evaluate(text, lambda key: self.keys.get(key, ""))

    def test_words_in_quotes_are_no_keys(self) -> None:
        assert names('way == "up" and "n" != key_1') == {"way", "key_1"}

    def test_the_check_tells_of_a_number_beside_a_text(self) -> None:
        count = '<Sequence><SetLocalBlackboard value="{}" output_key="n"/><Counter key="n"/>{}</Sequence>'
        ask = "<ConditionalExpression conditional_expression='n == \"3\"'/>"
        assert notes(count.format("2", ask)) == [r.NumberNotText("n"), r.NumberBesideText("n", "3")]
        assert notes(count.format("two", ask)) == []
        assert tree(count.format("2", ask)).tick() is SUCCESS

    def test_a_counter_drops_quotes(self) -> None:
        body = '<Sequence><SetLocalBlackboard value="&quot;2&quot;" output_key="n"/><Counter key="n"/></Sequence>'
        one = tree(body)
        assert one.tick() is SUCCESS
        assert stored(one) == {"n": "3"}
        assert notes(body) == []


NEED = {  # nodes that fail without a value of k, and their ports
    "MongoValueWriter": 'mongo_record_name="r" mongo_param_name="f" input_value="\\k\\"',
    "MongoArrayWriter": 'mongo_record_name="r" mongo_param_name="f" input_value="\\k\\" operation="add"',
    "MongoValueSearcher": 'mongo_param_name="a,b" mongo_value="1,\\k\\" output_port="o"',
    "BlackboardValueSearcherMongo": 'mongo_param_name="a" mongo_value="{k}" output_port="o"',
    "LocalBlackboardCaluculator": 'calculation_formula="{k} * 2" output_key="o"',
    "Counter": 'key="k"',
}


@pytest.mark.parametrize("name", NEED)
def test_a_key_that_nothing_gives_a_value_is_told_before(name: str) -> None:
    never, body = r.NeverWritten("k", name), f"<{name} {NEED[name]}/>"
    assert notes(body) == [never]
    for writer in (
        '<SetLocalBlackboard value="a" output_key="k"/>',
        '<SetBlackboard value="1" output_key="k"/>',
        '<MongoValueReader mongo_record_name="r" mongo_param_name="f" output_port="k"/>',
        '<LocalBlackboardCaluculator calculation_formula="1" output_key="k"/>',
        '<MongoValueSearcher mongo_param_name="a" mongo_value="1" output_port="k"/>',
        '<MongoValueReader mongo_record_name="r" mongo_param_name="f" output_port="{any}"/>',  # whichever key that is
    ):
        assert never not in notes(f"<Sequence>{body}{writer}</Sequence>")
    other = '<SetLocalBlackboard value="a" output_key="other"/>'
    assert notes(f"<Sequence>{other}{body}</Sequence>") == [never]


def test_a_constant_of_a_subtree_is_a_value() -> None:
    for constant, said in (('k="1"', []), ("", [r.NeverWritten("k", "Counter")])):
        text = document(f'<SubTreePlus ID="T1" {constant}/>', '<Counter key="k"/>')
        assert [what for _, what in check(text).warnings] == said


def test_a_counter_that_ends_a_name_needs_both() -> None:
    body = '<SetLocalBlackboardWithCounter key="pose" counter_key="n"/>'
    said = [r.NeverWritten(key, "SetLocalBlackboardWithCounter") for key in ("pose", "n")]
    assert notes(body) == said
    assert notes(f'<Sequence><SetLocalBlackboard value="0" output_key="n"/>{body}</Sequence>') == said[:1]
