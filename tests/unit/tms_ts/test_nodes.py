"""The custom nodes, one by one."""

from __future__ import annotations

import time
from typing import Any

import pytest

from tms_reason.reason import Foreign
from tms_ts.bt import FAILURE, RUNNING, SUCCESS, Status, TickError
from tms_ts.nodes.expression import _NUMBER, Invalid, evaluate, names
from tms_ts.nodes.shared_value import typed as written_as
from tms_ts.tree_reasons import AlwaysFails, KeyChangesType, KeyIsNumber, NoRosName, NumberTooBig
from tms_ts.world import GoalState
from unit.tms_ts.fakes import FakeClicks, FakeFlags, FakeMachines, FakeWorld
from unit.tms_ts.trees import leaf, tree


class TestLeafNode:
    @pytest.mark.parametrize(
        ("end", "status"),
        [(GoalState.SUCCEEDED, SUCCESS), (GoalState.FAILED, FAILURE), (GoalState.CANCELLED, FAILURE)],
    )
    def test_result_of_the_goal(self, end: GoalState, status: Status) -> None:
        fake = FakeWorld(FakeMachines(lasts=3, end=end))
        one = tree(leaf("TO_DUMP"), fake=fake)
        assert [one.tick(), one.tick(), one.tick()] == [RUNNING, RUNNING, status]
        goal = fake.machines.sent[0]
        assert (goal.machine, goal.subtask, goal.record, goal.node) == ("zx200", "st_zx200_swing", "TO_DUMP", "0")
        assert goal.cancels == 0

    def test_halt_cancels_once_and_the_next_tick_sends_anew(self) -> None:
        fake = FakeWorld(FakeMachines(lasts=100))
        one = tree(leaf(), fake=fake)
        one.tick()
        assert one.root.reason == Foreign("on the way")
        one.halt()
        one.halt()
        assert [goal.cancels for goal in fake.machines.sent] == [1]
        one.tick()
        assert len(fake.machines.sent) == 2

    def test_record_from_the_blackboard(self) -> None:
        fake = FakeWorld()
        one = tree(f'<Sequence><SetLocalBlackboard value="A" output_key="r"/>{leaf("{r}")}</Sequence>', fake=fake)
        one.tick()
        assert fake.machines.sent[0].record == "A"

    def test_record_without_a_value_names_the_node(self) -> None:
        one = tree(f"<Sequence>\n{leaf('{r}')}</Sequence>")
        with pytest.raises(TickError) as caught:
            one.tick()
        assert (caught.value.path, caught.value.line) == ("0.0", 4)
        assert "record_name" in str(caught.value)

    def test_odd_machine_name_is_a_warning(self) -> None:
        one = tree(leaf().replace('"zx200"', '"zx200＿"'))
        assert isinstance(one.warnings[0][1], NoRosName)


READ = '<BlackboardValueReaderMongo mongo_record_name="rec" mongo_param_name="f" output_port="k"/>'
WRITE = '<MongoValueWriter mongo_record_name="rec" mongo_param_name="f" input_value="7"/>'


class TestFlags:
    @pytest.mark.parametrize("value", ["a", True, 3, 2.5])
    def test_read_keeps_the_type(self, value: Any) -> None:
        one = tree(READ, fake=FakeWorld(flags=FakeFlags({("rec", "f"): value})))
        assert one.tick() is SUCCESS
        assert dict(one.blackboards[0].items()) == {"k": value}

    @pytest.mark.parametrize("value", [None, [1], {"a": 1}])
    def test_other_values_fail(self, value: Any) -> None:
        assert tree(READ, fake=FakeWorld(flags=FakeFlags({("rec", "f"): value}))).tick() is FAILURE

    def test_missing_record_fails(self) -> None:
        fake = FakeWorld(flags=FakeFlags(missing={"rec"}))
        assert tree(READ, fake=fake).tick() is FAILURE
        assert tree(WRITE, fake=fake).tick() is FAILURE

    def test_a_slow_database_stops_nothing(self) -> None:
        fake = FakeWorld(flags=FakeFlags(slow=True))
        one = tree(f"<Sequence>{WRITE}{READ}</Sequence>", fake=fake)
        assert [one.tick(), one.tick()] == [RUNNING, RUNNING]
        fake.flags.answer_all()
        assert one.tick() is RUNNING
        assert fake.flags.reads == 1
        one.halt()
        assert not one.running()

    def test_a_changed_type_is_taken_with_a_warning(self) -> None:
        fake = FakeWorld()
        one = tree(READ, fake=fake)
        one.tick()
        fake.flags.values["rec", "f"] = 5
        assert one.tick() is SUCCESS
        assert isinstance(one.warnings[0][1], KeyChangesType)

    def test_waiting_for_a_flag_does_not_halt_a_moving_machine(self) -> None:
        fake = FakeWorld(FakeMachines(lasts=4), flags=FakeFlags({("rec", "f"): True}))
        one = tree(
            f'<ReactiveSequence><Sequence>{READ}<ConditionalExpression conditional_expression="k==true"/></Sequence>'
            f"{leaf()}</ReactiveSequence>",
            fake=fake,
        )
        one.tick()
        fake.flags.slow = True
        for _ in range(20):
            status = one.tick()
            fake.flags.answer_all()
            if status.completed:
                break
        assert status is SUCCESS
        assert [goal.cancels for goal in fake.machines.sent] == [0]

    def test_a_flag_that_went_down_halts_the_machine(self) -> None:
        fake = FakeWorld(FakeMachines(lasts=100), flags=FakeFlags({("rec", "f"): True}))
        one = tree(
            f'<ReactiveSequence>{READ}<ConditionalExpression conditional_expression="k==true"/>{leaf()}'
            "</ReactiveSequence>",
            fake=fake,
        )
        one.tick()
        fake.flags.values["rec", "f"] = False
        assert one.tick() is FAILURE
        assert [goal.cancels for goal in fake.machines.sent] == [1]

    @pytest.mark.parametrize(
        ("text", "value"),
        [("true", True), ("false", False), ("100", 100), ("-3", -3), ("3_FLG", 3), ("12abc", 12), ("2.5", 2.5),
         ("1.", 1.0), ("Hello", "Hello"), ("True", "True"), ("", ""), ("a.b", "a.b"),
         ("99999999999", 99999999999.0), ("9" * 50 + "_FLG", 1e50), ("9" * 500, "9" * 500)],
    )  # fmt: skip
    def test_writer_types(self, text: str, value: Any) -> None:
        assert written_as(text) == value
        assert type(written_as(text)) is type(value)


KEYS: dict[str, Any] = {"yes": True, "no": False, "one": 1, "half": 0.5, "name": "A", "same": "A", "text": "true",
                        "big": 5_000_000_000}  # fmt: skip


class TestExpression:
    @pytest.mark.parametrize(
        ("text", "result"),
        [
            ("yes == true", True),
            ("yes==false", False),
            ("no != true", True),
            ("one == 1 and yes == true", True),
            ("yes == 1", True),
            ("one == true", True),
            ("no==true or one==1 and no==true", False),
            ("( no == true or\n  yes == true  )  and one==1", True),
            ("name == same", True),
            ("name != same", False),
            ("missing1 == missing2", True),
            ("one > 0 and half <= 0.5 and one == 1.0 and one != -1", True),
            ("yes", True),
            ("no", False),
            ("true", True),
            ("text == true", True),
            ("one == 01 and 007 == 7.0 and half == 00.5", True),
            ("one == 1and yes == true", True),
            ("big == 5000000000 and one == 1e0", True),
            ("name == same == true", True),
        ],
    )
    def test_value(self, text: str, result: bool) -> None:
        assert evaluate(text, lambda key: KEYS.get(key, "")) is result

    @pytest.mark.parametrize(
        "text",
        [
            "", "missing == true", "missing != true", "yes==true or missing==true", "name == 1", "name", "yes = true",
            "yes == true and", "(yes == true", "not yes", "yes && no", "__import__('os')", "yes.real",
            "yes if one else no",
            "9**9**9", "[1]", "lambda: 1", "(" * 70 + "1" + ")" * 70, "1 " * 5000, "one + 1 == 2", "name == 'A'",
            "name < same",
            "yes == true; no", "f(yes)", "２ == 2", "16 == 0x10", "1_0 == 10", "1x == 1", "1e5x", "1and_ == 1",
        ],
    )  # fmt: skip
    def test_invalid(self, text: str) -> None:
        with pytest.raises(Invalid):
            evaluate(text, lambda key: KEYS.get(key, ""))

    def test_a_long_row_of_zeros_is_read_once(self) -> None:
        row, start = "0" * 30_000 + "x", time.process_time()
        assert _NUMBER.sub(r"\1 \2", row) == row
        assert time.process_time() - start < 5  # s; a pattern that goes back to every zero takes half a minute
        assert _NUMBER.sub(r"\1 \2", "000 == 007.50and 00e5 != 0.0") == "0  == 7.50 and 0e5  != 0.0 "

    def test_python_words_are_only_keys(self) -> None:
        assert evaluate("None == one and import == 1", {"None": 1, "import": 1, "one": 1}.__getitem__)
        assert names("(a==true or B_1 != 3) and false") == {"a", "B_1"}

    def test_node(self) -> None:
        one = tree('<ConditionalExpression conditional_expression="k == true"/>', blackboard={"k": True})
        assert one.tick() is SUCCESS
        assert tree('<ConditionalExpression conditional_expression="k == true"/>').tick() is FAILURE

    def test_bool_node_wants_booleans(self) -> None:
        body = '<ConditionalExpressionBool conditional_expression_bool="{}"/>'
        assert tree(body.format("k == true"), blackboard={"k": True, "n": 1}).tick() is SUCCESS
        assert tree(body.format("k == true or s == s"), blackboard={"k": True, "s": "A"}).tick() is FAILURE
        assert tree(body.format("k == true or other == false"), blackboard={"k": True}).tick() is FAILURE
        one = tree(body.format("k == false or n == 1"), blackboard={"k": True, "n": 1})
        assert one.tick() is SUCCESS
        assert isinstance(one.warnings[0][1], KeyIsNumber)

    def test_a_number_that_the_cpp_system_leaves_out_is_a_warning(self) -> None:
        one = tree('<ConditionalExpression conditional_expression="k == 2147483648"/>', blackboard={"k": 2**31})
        assert one.tick() is SUCCESS
        assert isinstance(one.warnings[0][1], NumberTooBig)

    def test_a_hopeless_expression_is_a_warning(self) -> None:
        one = tree('<ConditionalExpression conditional_expression="k = true"/>')
        assert isinstance(one.warnings[0][1], AlwaysFails)


class TestKeepRunningUntilFlgup:
    body = '<KeepRunningUntilFlgup key="k">{}</KeepRunningUntilFlgup>'

    def test_child(self) -> None:
        assert tree(self.body.format("<AlwaysFailure/>"), blackboard={"k": True}).tick() is FAILURE
        assert tree(self.body.format(leaf()), blackboard={"k": True}).tick() is RUNNING

    @pytest.mark.parametrize(
        ("values", "status", "warned"),
        [({}, RUNNING, False), ({"k": False}, RUNNING, False), ({"k": True}, SUCCESS, False),
         ({"k": "true"}, SUCCESS, True), ({"k": "false"}, RUNNING, True)],
    )  # fmt: skip
    def test_flag(self, values: dict[str, Any], status: Status, warned: bool) -> None:
        one = tree(self.body.format("<AlwaysSuccess/>"), blackboard=values)
        assert one.tick() is status
        assert bool(one.warnings) is warned

    @pytest.mark.parametrize("value", [1, "up"])
    def test_no_flag(self, value: Any) -> None:
        with pytest.raises(TickError, match="not true or false"):
            tree(self.body.format("<AlwaysSuccess/>"), blackboard={"k": value}).tick()


class TestLocalValues:
    @pytest.mark.parametrize(
        ("text", "value"),
        [
            ("true", True),
            ("false", False),
            ("12", 12),
            ("-3", -3),
            ("2.5", 2.5),
            ("1.", "1."),
            ("x1", "x1"),
            ("TRUE", "TRUE"),
        ],
    )
    def test_set_local_blackboard(self, text: str, value: Any) -> None:
        one = tree(f'<SetLocalBlackboard value="{text}" output_key="N_FLG "/>')
        assert one.tick() is SUCCESS
        assert dict(one.blackboards[0].items()) == {"N_FLG ": value}

    def test_set_local_blackboard_needs_its_ports(self) -> None:
        for body in ('<SetLocalBlackboard value="1"/>', '<SetLocalBlackboard output_key="k"/>'):
            with pytest.raises(TickError):
                tree(body).tick()

    def test_counted_names(self) -> None:
        one = tree(
            '<Sequence><Counter key="n"/><SetLocalBlackboardWithCounter key="pose" counter_key="n"/></Sequence>',
            blackboard={"n": "9", "pose": "pose_0"},
        )
        assert one.tick() is SUCCESS
        assert dict(one.blackboards[0].items()) == {"n": "10", "pose": "pose_10"}

    def test_the_counter_is_put_in_as_it_is(self) -> None:
        one = tree(
            '<SetLocalBlackboardWithCounter key="pose" counter_key="n"/>',
            blackboard={"n": r"\1", "pose": "pose_0"},
        )
        assert one.tick() is SUCCESS
        assert dict(one.blackboards[0].items())["pose"] == r"pose_\1"

    @pytest.mark.parametrize(
        "body",
        ['<Counter key="n"/>', '<Counter key="text"/>', '<SetLocalBlackboardWithCounter key="text" counter_key="n"/>',
         '<SetLocalBlackboardWithCounter key="n" counter_key="text"/>', '<BlackboardValueChecker key="n"/>'],
    )  # fmt: skip
    def test_missing_values_fail(self, body: str) -> None:
        assert tree(body, blackboard={"text": "abc"}).tick() is FAILURE

    def test_a_number_that_is_counted_stays_one(self) -> None:
        one = tree('<Sequence><SetLocalBlackboard value="1" output_key="n"/><Counter key="n"/></Sequence>')
        assert one.tick() is SUCCESS
        assert dict(one.blackboards[0].items()) == {"n": 2}

    def test_a_text_for_a_port_of_another_type_is_converted(self) -> None:
        fake = FakeWorld(flags=FakeFlags({("rec", "f"): "3"}))
        one = tree(f'<Sequence>{READ}<Repeat num_cycles="{{k}}"><Counter key="n"/></Repeat></Sequence>',
                   fake=fake, blackboard={"n": "0"})  # fmt: skip
        assert one.tick() is SUCCESS
        assert dict(one.blackboards[0].items()) == {"k": 3, "n": "3"}
        assert not one.warnings

    def test_checker_succeeds(self) -> None:
        assert tree('<BlackboardValueChecker key="k"/>', blackboard={"k": 1}).tick() is SUCCESS


class TestWaitForClick:
    body = '<WaitForClick window_title="Stop1" button_info="go?"/>'

    def test_answers(self) -> None:
        assert tree(self.body, fake=FakeWorld(clicks=FakeClicks(True))).tick() is SUCCESS
        assert tree(self.body, fake=FakeWorld(clicks=FakeClicks(False))).tick() is FAILURE

    def test_waits_and_is_withdrawn(self) -> None:
        fake = FakeWorld(clicks=FakeClicks(None))
        one = tree(self.body, fake=fake)
        assert [one.tick(), one.tick()] == [RUNNING, RUNNING]
        assert fake.clicks.asked == [("Stop1", "go?")]
        one.halt()
        assert fake.clicks.withdrawn == 1


def test_a_lock_that_says_who_has_it_is_not_waited_for_by_its_own_holder() -> None:
    swap = '<MongoValueSwap mongo_record_name="ROAD" mongo_param_name="holder" expected_value="{}" input_value="{}"/>'
    flags = FakeFlags({("ROAD", "holder"): "free"})

    def take(me: str) -> Status:
        body = f"<Fallback>{swap.format('free', me)}{swap.format(me, me)}</Fallback>"
        return tree(body, fake=FakeWorld(flags=flags)).tick()

    assert [take("zx200"), take("zx200"), take("ic120")] == [SUCCESS, SUCCESS, FAILURE]
    assert flags.values["ROAD", "holder"] == "zx200"
