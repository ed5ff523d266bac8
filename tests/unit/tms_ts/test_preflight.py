"""What preflight finds, with the line of the tree."""

from dataclasses import dataclass, field
from pathlib import Path

import pytest
import yaml

from conftest import site_data
from tms_config.config import CONFIGS, Site, load_site
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_decision.reasons import MachineLatched, SoftwareStop
from tms_machine.goal_inputs import Inputs
from tms_machine.reasons import InputsNotTaken
from tms_reason.reason import Foreign, Reason
from tms_reason.texts import advice
from tms_ts import bt
from tms_ts.preflight import Refusal, StoredRecord, Values, at, machines_of, preflight, processes_of, records_of
from tms_ts.reasons import MotionRefused, MotionRefusedNow, NobodyWrites, RecordUnfit
from tms_ts.surroundings import unfit
from words import words

LEAF = '<Action ID="LeafNodeZx200" model_name="{}" record_name="{}" subtask_name="{}"/>\n'


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Site:
    monkeypatch.delenv("ROS_DOMAIN_ID", raising=False)
    file = tmp_path / "site.yaml"
    file.write_text(yaml.safe_dump(site_data(52, 22000)))
    return load_site(str(file))


def tree(*leaves: tuple[str, str, str]) -> bt.Tree:
    inner = "".join(LEAF.format(*leaf) for leaf in leaves)
    text = f'<root main_tree_to_execute="T"><BehaviorTree ID="T"><Sequence>\n{inner}</Sequence></BehaviorTree></root>'
    return bt.load(text, world=None)


POSE = {"swing_joint": 0.0, "boom_joint": 0.0, "arm_joint": 0.0, "bucket_joint": 0.0, "trajectory": 1}


def test_several_records_of_a_goal_are_looked_at_one_by_one(site: Site) -> None:
    several = tree(("zx200", "pose, none,pose", "subtask_zx200_change_pose"))
    assert records_of(several) == ["zx200/pose", "zx200/none"]
    found = preflight(several, site, Context())
    assert len(found.errors) == 1 and "zx200/none" in words(found.errors[0])


@dataclass
class Context:
    """The surroundings in memory."""

    records: dict[tuple[str, str], StoredRecord] = field(
        default_factory=lambda: {("zx200", "pose"): StoredRecord(POSE)}
    )
    writers: set[tuple[str, str]] = field(default_factory=set)
    problems: dict[str, Reason] = field(default_factory=dict)
    silent_input: str = ""
    misfit: Reason | None = None
    inputs: dict[str, str | bool] = field(default_factory=dict)  # that were looked at
    refusals: dict[str, Refusal] = field(default_factory=dict)  # of a planner, by record
    rehearsed: list[tuple[str, str]] = field(default_factory=list)

    def record(self, machine: str, record: str) -> StoredRecord | None:
        return self.records.get((machine, record))

    def names(self, machine: str) -> list[str]:
        return [record for of, record in self.records if of == machine]

    def misread(self, machine: str, subtask: str) -> Reason | None:
        return None

    def served(self, machine: str, subtask: str) -> bool:
        return False

    def problem(self, machine: str) -> Reason | None:
        return self.problems.get(machine)

    def written(self, record: str, field: str) -> bool:
        return (record, field) in self.writers

    def silent(self, machine: str, record: str) -> str:
        return self.silent_input

    def unfit(self, machine: str, subtask: str, values: Values, inputs: Inputs) -> Reason | None:
        self.inputs.update(inputs)
        return self.misfit

    def oldest(self, machine: str, subtask: str) -> float:
        return 0.0

    def refusal(self, machine: str, subtask: str, record: str, inputs: Inputs) -> Refusal | None:
        self.rehearsed.append((machine, record))
        return self.refusals.get(record)

    def unplanned(self) -> list[Reason]:
        return []


GOOD = ("zx200", "pose", "subtask_zx200_change_pose")


def test_what_is_found_in_a_template_names_the_template_and_the_call(site: Site) -> None:
    task = """<root><BehaviorTree ID="T"><Sequence>
    <Action ID="ExecuteSubtask" subtask_name="Dig" model_name="zx200" pose="gone"/>
    <Action ID="ExecuteSubtask" subtask_name="Look"/></Sequence></BehaviorTree></root>"""
    templates = {
        name: f'<root>\n<BehaviorTree ID="B">\n{body}</BehaviorTree></root>'
        for name, body in {
            "Dig": LEAF.format("$model_name$", "$pose$", "subtask_zx200_change_pose"),
            "Look": '<BlackboardValueReaderMongo mongo_record_name="FLAGS" mongo_param_name="f" output_port="{x}"/>',
        }.items()
    }
    found = preflight(bt.load(task, templates=templates.get), site, Context())
    assert [words(error) for error in found.errors] == ["line 2: in template Dig:3: no record zx200/gone"]
    assert any(words(one).startswith("line 3: in template Look:3: ") for one in found.warnings)


def test_a_record_that_is_nearly_there_is_named(site: Site) -> None:
    found = preflight(tree(("zx200", "poze", "subtask_zx200_change_pose")), site, Context())
    assert words(found.errors[0]) == "line 2: no record zx200/poze; did you mean 'pose'?"
    assert advice(found.errors[0], "en") == "Add the record: `tms param set zx200/poze --create FIELD=VALUE`"


def test_a_good_tree(site: Site) -> None:
    loaded = tree(GOOD, GOOD)
    assert preflight(loaded, site, Context()).errors == []
    assert machines_of(loaded) == ["zx200"]
    assert processes_of(loaded, site) == ["zx200:subtask_zx200_change_pose"]


@pytest.mark.parametrize(
    ("leaf", "said"),
    [
        (("zx999", "pose", "subtask_zx200_change_pose"), "line 3: the site has no machine 'zx999' (there: zx200)"),
        (("zx200", "pose", "st_fly"), "line 3: zx200 offers no 'st_fly' (there: subtask_zx200_change_pose"),
        (
            ("zx200", "none", "subtask_zx200_change_pose"),
            "line 3: no record zx200/none",
        ),
    ],
)
def test_errors_name_line_and_remedy(site: Site, leaf: tuple[str, str, str], said: str) -> None:
    found = preflight(tree(GOOD, leaf), site, Context())
    assert len(found.errors) == 1
    assert said in words(found.errors[0])


def test_what_only_the_run_decides_is_a_warning(site: Site) -> None:
    loaded = tree(("{m}", "pose", "subtask_zx200_change_pose"), ("zx200", "{r}", "subtask_zx200_change_pose"))
    found = preflight(loaded, site, Context())
    assert found.errors == []
    assert any("line 2" in words(text) for text in found.warnings)


@pytest.mark.parametrize(
    ("around", "said"),
    [
        (Context({GOOD[:2]: StoredRecord(POSE, "dynamic", 12.0, 5.0)}),
         "line 2: record zx200/pose is 12.0 s old, allowed"),
        (Context({GOOD[:2]: StoredRecord(POSE, "dynamic", None, 5.0)}), "line 2: record zx200/pose is of unknown age"),
        (Context(silent_input="digger"), "line 2: sensing input digger should write record zx200/pose and is silent"),
        (Context(problems={"zx200": MachineLatched("zx200", SoftwareStop())}), "zx200 is stopped: software stop"),
    ],
)  # fmt: skip
def test_what_may_be_right_when_the_leaf_starts_is_a_warning(site: Site, around: Context, said: str) -> None:
    found = preflight(tree(GOOD), site, around)
    assert found.errors == []
    assert [text for text in found.warnings if said in words(text)], found.warnings


def test_a_record_that_does_not_fit_its_subtask_is_an_error(site: Site) -> None:
    found = preflight(tree(GOOD), site, Context(misfit=Foreign("boom_joint: Field required")))
    unfit = RecordUnfit("zx200/pose", "subtask_zx200_change_pose", Foreign("boom_joint: Field required"))
    assert found.errors == [at(2, unfit)]


READ = '<Action ID="BlackboardValueReaderMongo" mongo_record_name="ROAD" mongo_param_name="{}" output_port="x"/>'
WRITE = '<Action ID="MongoValueWriter" mongo_record_name="ROAD" mongo_param_name="{}" input_value="true"/>'


def flags(inner: str, before: str = "<Repeat num_cycles='-1'>", after: str = "</Repeat>") -> bt.Tree:
    text = f"<Sequence>{before}<Sequence>{inner}</Sequence>{after}</Sequence>"
    return bt.load(f'<root main_tree_to_execute="T"><BehaviorTree ID="T">{text}</BehaviorTree></root>', world=None)


WAITED = NobodyWrites("FREE", "ROAD")
ROAD = {("", "ROAD"): StoredRecord({"FREE": False}, "dynamic")}


@pytest.mark.parametrize(
    ("machine", "subtask", "values", "said"),
    [
        ("zx200", "subtask_zx200_change_pose", POSE | {"boom_joint": 0.5},
         "boom_joint: 0.500 rad is above its limit -0.100 rad"),
        ("zx200", "subtask_zx200_change_pose", {"pose": 1, "boom_joint": 0.5}, ""),  # this joint does not count
        ("zx200", "subtask_zx200_release_simple", {"target_angle": -1.0},
         "bucket_joint: -1.000 rad is below its limit -0.622 rad"),
        ("zx200", "st_zx200_sample_boom", {"zx200_boom_goal_pos": -5.0}, "above"),
        ("zx200", "st_zx200_sample_boom", {"zx200_boom_goal_pos": -30.0}, ""),
        ("ic120", "st_ic120_release_soil", {"target_angle": 1.0}, "above"),
        ("ic120", "st_ic120_release_soil", {"target_angle": 0.0}, ""),
        ("mst110cr", "st_mst110cr_swing", {"target_angle": 100.0}, ""),  # turns for ever
    ],
)  # fmt: skip
def test_an_angle_beyond_the_limit_of_its_joint_does_not_fit(
    site: Site, machine: str, subtask: str, values: dict[str, float], said: str
) -> None:
    found = unfit(parse(CONFIGS / "machines" / f"{machine}.yaml", MachineModel), subtask, values, {})
    assert said in words(found)
    assert bool(said) == (found is not None)
    errors = preflight(tree(GOOD), site, Context(misfit=found)).errors
    assert len(errors) == bool(said)


def test_an_input_that_the_subtask_does_not_take_does_not_fit() -> None:
    model = parse(CONFIGS / "machines" / "mst110cr.yaml", MachineModel)
    path = {"x": [0.0], "y": [0.0], "z": [0.0], "qx": [0.0], "qy": [0.0], "qz": [0.0], "qw": [1.0]}
    down: Inputs = {"read_direction": "down"}
    assert unfit(model, "st_mst110cr_follow_waypoints", path, down) is None
    assert unfit(model, "st_mst110cr_follow_waypoints", path | {"read_direction": 5}, {}) is not None
    assert unfit(model, "st_mst110cr_follow_waypoints", path | {"read_direction": 5}, down) is None  # as in the run
    assert unfit(model, "st_mst110cr_swing", {"target_angle": 1.0}, down) == InputsNotTaken(("read_direction",))
    assert unfit(model, "st_mst110cr_swing_align_to_heading", {}, down) == InputsNotTaken(("read_direction",))


def primitive(ports: str) -> bt.Tree:
    text = f'\n<Action ID="LeafNodeExcavator" model_name="zx200" primitive_name="subtask_zx200_change_pose" {ports}/>'
    return bt.load(f'<root main_tree_to_execute="T"><BehaviorTree ID="T">{text}</BehaviorTree></root>', world=None)


def test_a_primitive_is_a_subtask_of_the_model_and_its_inputs_are_checked(site: Site) -> None:
    around = Context()
    ports = 'target_record_name="pose" previous_target_record_name="{}"'
    assert preflight(primitive(ports.format("before")), site, around).errors == []
    assert around.inputs == {"previous_target_record_name": "before"}
    assert preflight(primitive(ports.format("{key}")), site, around).errors == []
    assert around.inputs == {"previous_target_record_name": "before"}  # the other one is known only during the run
    (error,) = preflight(primitive('record_name="poze" previous_target_record_name="{key}"'), site, around).errors
    assert "no record zx200/poze; did you mean 'pose'" in words(error)


@pytest.mark.parametrize(
    ("name", "said"), [("primitive_fly", "zx200 offers no 'primitive_fly'"), ("", "has nothing in")]
)
def test_a_primitive_that_is_not_there(site: Site, name: str, said: str) -> None:
    body = f'<Action ID="LeafNodeCommon" model_name="zx200" primitive_name="{name}" record_name="pose"/>'
    text = f'<root main_tree_to_execute="T"><BehaviorTree ID="T">{body}</BehaviorTree></root>'
    (error,) = preflight(bt.load(text, world=None), site, Context()).errors
    assert said in words(error)


def test_a_flag_that_is_waited_for_and_that_nobody_writes_is_a_warning(site: Site) -> None:
    reader = flags(READ.format("FREE"))
    assert at(1, WAITED) in preflight(reader, site, Context(ROAD)).warnings
    others = [
        preflight(reader, site, Context(ROAD, writers={("ROAD", "FREE")})),
        preflight(flags(READ.format("FREE") + WRITE.format("FREE")), site, Context(ROAD)),
        preflight(flags(READ.format("FREE"), "", ""), site, Context(ROAD)),
    ]
    assert not any(text.find(NobodyWrites) for found in others for text in found.warnings)


def test_shared_records_and_fields_should_be_there_and_not_static(site: Site) -> None:
    """Warnings, since trees of the field name records that a branch which is never taken would need."""
    static = Context({("", "ROAD"): StoredRecord({"FREE": False}, "static")})
    for inner, around, said in (
        (READ.format("FREE"), Context({}), "no shared record ROAD"),
        (READ.format("TAKEN"), Context(ROAD), "has no field 'TAKEN'"),
        (READ.format("FREE"), Context({("", "ROAD"): StoredRecord({"FREE": [1]}, "dynamic")}), "is not a plain value"),
        (READ.format("FREE"), Context({("", "ROAD"): StoredRecord({"FREE": 2**40}, "dynamic")}), "too big for 32 bits"),
        (WRITE.format("FREE"), static, "is static"),
    ):
        found = preflight(flags(inner), site, around)
        assert found.errors == []
        assert [text for text in found.warnings if said in words(text)], found.warnings


def test_the_records_that_a_tree_names(site: Site) -> None:
    loaded = tree(GOOD, ("zx200", "{r}", "subtask_zx200_change_pose"))
    assert records_of(loaded) == ["zx200/pose", "zx200/*"]
    assert records_of(flags(READ.format("FREE"))) == ["/ROAD"]


@pytest.mark.parametrize("name", ["st_zx200_dig ", "st-zx200", "st/", "1st", "掘る", "s" * 201])
def test_a_subtask_that_can_be_no_ros_name_is_refused_before_ros_is_asked(site: Site, name: str) -> None:
    class Asked(Context):
        def served(self, machine: str, subtask: str) -> bool:
            raise ValueError("rclpy takes no such name")

    found = preflight(tree(("zx200", "pose", name)), site, Asked())
    (error,) = found.errors
    assert words(error).startswith(f"line 2: '{name[:90]}")
    assert words(error).endswith(" can be no ROS name: at most 200 letters, digits and _, no blanks")


def dig(attributes: str, before: str = "") -> bt.Tree:
    """The tree `Dig`, whose machine and record its user names."""
    text = (
        f'<root main_tree_to_execute="T"><BehaviorTree ID="T"><SubTreePlus ID="Dig" {attributes}/></BehaviorTree>\n'
        f'<BehaviorTree ID="Dig"><Sequence>{before}{LEAF.format("{machine}", "{pose}", "subtask_zx200_change_pose")}'
        "</Sequence></BehaviorTree></root>"
    )
    return bt.load(text, world=None)


def test_constants_of_a_subtree_are_known_before_the_run(site: Site) -> None:
    loaded = dig('machine="zx200" pose="pose"')
    assert machines_of(loaded) == ["zx200"]
    assert processes_of(loaded, site) == ["zx200:subtask_zx200_change_pose"]
    assert records_of(loaded) == ["zx200/pose"]
    assert preflight(loaded, site, Context()).errors == []
    assert "no record zx200/none" in words(preflight(dig('machine="zx200" pose="none"'), site, Context()).errors[0])
    assert "no machine 'zx999'" in words(preflight(dig('machine="zx999" pose="pose"'), site, Context()).errors[0])


@pytest.mark.parametrize(
    "writer",
    [
        '<SetBlackboard output_key="pose" value="pose_1"/>',
        '<SetBlackboard output_key="{pose}" value="pose_1"/>',
        '<SetLocalBlackboard output_key="pose" value="pose_1"/>',
        '<SetLocalBlackboardWithCounter key="pose" counter_key="n"/>',
        '<BlackboardValueReaderMongo mongo_record_name="ROAD" mongo_param_name="FREE" output_port="pose"/>',
    ],
)
def test_a_constant_that_a_node_may_write_is_known_only_to_the_run(site: Site, writer: str) -> None:
    loaded = dig('machine="zx200" pose="pose_0" n="1"', writer)
    assert machines_of(loaded) == ["zx200"]
    assert records_of(loaded)[0] == "zx200/*"
    assert preflight(loaded, site, Context()).errors == []


@pytest.mark.parametrize(
    ("lasting", "type_", "error"), [(True, "static", True), (False, "static", False), (True, "dynamic", False)]
)
def test_what_a_planner_would_refuse_is_an_error_only_if_nothing_can_change_it(
    site: Site, lasting: bool, type_: str, error: bool
) -> None:
    around = Context({GOOD[:2]: StoredRecord(POSE, type_, 0.0)}, refusals={"pose": Refusal(Foreign("no"), lasting)})
    found = preflight(tree(GOOD), site, around)
    kind = MotionRefused if error else MotionRefusedNow
    said = found.errors if error else found.warnings
    assert [one.find(kind) for one in said] == [kind("zx200/pose", GOOD[2], Foreign("no"))]
    assert not (found.warnings if error else found.errors)


def test_motions_are_planned_in_the_order_of_the_task_and_only_of_records_that_are_right(site: Site) -> None:
    around = Context({GOOD[:2]: StoredRecord(POSE), ("zx200", "other"): StoredRecord(POSE)})
    leaves = (GOOD, ("zx200", "none", GOOD[2]), ("zx200", "{r}", GOOD[2]), ("zx200", "other", GOOD[2]), GOOD)
    preflight(tree(*leaves), site, around)
    assert around.rehearsed == [("zx200", "pose"), ("zx200", "other"), ("zx200", "pose")]
