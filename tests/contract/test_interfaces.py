"""The wire: type hashes of what other people's nodes exchange, and packages that hold all their files."""

import importlib
import json
import re
import sys
from pathlib import Path

import pytest

from conftest import PROJECT
from tms_machine.peer_forms import HASHES

INTERFACES = PROJECT / "services" / "interfaces"
FORMS = INTERFACES / "_forms"  # packages of the same names, each form in a prefix of its own
PACKAGES = sorted(path.parent for folder in (INTERFACES, FORMS) for path in folder.glob("*/package.xml"))

# Hashes of the definitions as published; a peer with other hashes would misread our data.
KNOWN = {
    "std_msgs/msg/String": "df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18",
    "geometry_msgs/msg/Twist": "9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a",
    "sensor_msgs/msg/JointState": "a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e",
    "trajectory_msgs/msg/JointTrajectory": "179b33eba59d676f6d967ac71fe35e7ca2f64b2f3928f4a018cec115e213796e",
    "tms_msg_ts/action/LeafNodeBase": "18ac53b3e0981c3b5ef466999808635439680dfa9cbd70fa70e85f173bd51777",
    "tms_msg_db/srv/TmsdbGetData": "a64685a4405bfdd123c5237a516189015bba728e29bdd1fc6b07f61f7a65163a",
    "tms_msg_rp/action/TmsRpZx200ChangePose": "29ea3b501a7ddd971d6d3dd4344be4650d89bbab6c10222bf50a6b1618b59a5c",
    "com3_msgs/action/SetSwingAngle": "cc23502c721683d4350dfd34bf3aba11df061711c0e568adf7e818788356d430",
    "nav2_msgs/action/NavigateToPose": "a56dba8a3234a1215e610180dc703ae25bbf406dded8b54887891c9732857eab",
    "nav2_msgs/action/NavigateThroughPoses": "4e680a34fd27772095da6ffdb32ae348adbc3d948248d38cf8d5ca3fc7a3a6c4",
    "nav2_msgs/action/ComputePathToPose": "b11d50c914791956069419b8f4ad441e3c66fcfbd9461f8e87110b77dc6febe9",
    "nav2_msgs/action/FollowPath": "9d95513552fb578cfb933d7e0160273911269cbdf4b348f1acb87d8a903b13cf",
    "nav2_msgs/action/FollowWaypoints": "09e36a19e0374ab692e78b877e3345daa223ca4186b8af90f77939b78c6e6d7b",
    "control_msgs/action/FollowJointTrajectory": "738ebcb7a2d7cfa42f9f1001cc99ce3a4383d1cfe508015d9be8485e4b1c66f6",
}

# The forms of version 6, by their definitions as read; without a peer of theirs to compare them with.
KNOWN_FORMS = {
    ("", "tms_msg_rp/action/TmsRpExcavator"): "3b4d7264d3c192a4ba436a17a9d99f84384ed1e66f10690aaa53d655332d199c",
    ("", "tms_msg_rp/action/TmsRpFollowStraight"): "300da29a4b3a97ec5bff7cacd39b3d1147348405e64433f11d85c63f17ea373b",
    ("v6a", "tms_msg_ts/action/LeafNodeBase"): "cb6b24b5c49884d4464bf769ba1c45fb583556275ec0c03cc342db9e63122559",
    ("v6b", "tms_msg_ts/action/LeafNodeBase"): "dfc42e8bd08861795e637231ba18ab99dcefc262ae113b0ced99f48cc42547ed",
    ("param_type", "tms_msg_db/srv/TmsdbGetTask"): "dd546b6a3bb1944f0ca404d5855507421c5ce02584c56243474424b12cbc330d",
    ("both", "tms_msg_db/srv/TmsdbGetTask"): "dd546b6a3bb1944f0ca404d5855507421c5ce02584c56243474424b12cbc330d",
    ("param_type", "tms_msg_db/srv/TmsdbGetData"): "3982c7709d44f80137db707738b0d5d1b52d8465442590a076e0b97f4c895a77",
    ("both", "tms_msg_db/srv/TmsdbGetData"): "99811e4e4c7d8c56f045e7714758222cdbe5f8912584630a054fdad66df27ef4",
    ("plans", "tms_msg_rp/action/TmsRpExcavator"): "a74359ea9b50a0fcf20cff4620697d73fc9a04ac4a4c7586ce8074c96b8f38c8",
}


FORM = re.compile(r"^build_form\((\w+) (\w+)", re.MULTILINE)


def built_hash(name: str, prefix: Path = Path(sys.prefix), part: str = "") -> str:
    package, kind, _ = name.split("/")
    file = prefix / "share" / package / kind / f"{name.split('/')[2]}.json"
    hashes = {row["type_name"]: row["hash_string"] for row in json.loads(file.read_text())["type_hashes"]}
    return hashes[name + part].removeprefix("RIHS01_")


@pytest.mark.parametrize("name", sorted(KNOWN))
def test_type_hash(name: str) -> None:
    assert built_hash(name) == KNOWN[name]


@pytest.mark.parametrize(("form", "name"), sorted(KNOWN_FORMS))
def test_type_hash_of_another_form(form: str, name: str) -> None:
    prefix = Path(sys.prefix, "share", "tms_forms", form) if form else Path(sys.prefix)
    assert built_hash(name, prefix) == KNOWN_FORMS[form, name]


@pytest.mark.parametrize(("definition", "form"), [(name, form) for name, forms in HASHES.items() for form in forms])
def test_a_peer_is_known_by_the_hash_of_its_goals(definition: str, form: str) -> None:
    package = {"LeafNodeBase": "tms_msg_ts", "TmsRpExcavator": "tms_msg_rp"}[definition]
    usual = form in ("v5", "plan")
    prefix = Path(sys.prefix) if usual else Path(sys.prefix, "share", "tms_forms", form)
    told = built_hash(f"{package}/action/{definition}", prefix, "_SendGoal_Request")
    assert HASHES[definition][form] == f"RIHS01_{told}"
    others = ("_SendGoal_Response", "_GetResult_Request", "_GetResult_Response", "_FeedbackMessage")
    name = f"{package}/action/{definition}"
    assert [built_hash(name, prefix, part) for part in others] == [built_hash(name, part=part) for part in others]


@pytest.mark.parametrize("package", PACKAGES, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_every_definition_is_built(package: Path) -> None:
    text = (package / "CMakeLists.txt").read_text()
    forms = FORM.findall((INTERFACES / "_wheel" / "CMakeLists.txt").read_text())
    built = "".join([text, *(text.replace("${FORM}", form) for form, name in forms if name == package.name)])
    if text.count("set(FORM ") > 1:  # the usual build has one of them
        built += text.replace("${FORM}", re.findall(r"set\(FORM (\w+)\)", text)[0])
    listed = set(re.findall(r'"(?:\$\{CMAKE_CURRENT_SOURCE_DIR\}/(\w+):)?(\w+/\w+\.\w+)"', built))
    there = {path.relative_to(package) for kind in ("msg", "srv", "action") for path in package.rglob(f"*.{kind}")}
    assert {f"{base}/{file}" if base else file for base, file in listed} == {str(path) for path in there}


@pytest.mark.parametrize("package", PACKAGES, ids=lambda path: path.name)
def test_every_generated_class_imports(package: Path) -> None:
    for kind in ("msg", "srv", "action"):
        for file in sorted((package / kind).glob(f"*.{kind}")):
            assert hasattr(importlib.import_module(f"{package.name}.{kind}"), file.stem)
