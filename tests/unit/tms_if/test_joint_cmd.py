"""Both layouts of JointCmd: rewritten without loss, and never mistaken for each other where that can be known."""

import struct

import pytest

from tms_if.joint_cmd import HEADER, JointCmd, LayoutError, convert, read, write

FRONT = [b"bucket_joint", b"arm_joint", b"boom_joint", b"swing_joint"]  # the official order ends off a boundary


def message(control_type: int | None, names: list[bytes] = FRONT) -> JointCmd:
    return JointCmd(names, control_type, [0.1 * i for i in range(len(names))], [], [])


@pytest.mark.parametrize("last", [b"swing_joint", b"bucket_end_joint", b"turn_volume", b"arm_joint"])
def test_there_and_back(last: bytes) -> None:
    whole = write(message(0, [b"boom_joint", last]), "control_type")
    plain = convert(whole, "plain")
    assert read(plain, "plain") == message(None, [b"boom_joint", last])
    assert convert(plain, "control_type") == whole


def test_bytes_of_both_layouts() -> None:
    one = JointCmd([b"swing_joint"], 2, [1.0], [], [])
    name = struct.pack("<II", 1, 12) + b"swing_joint\0"
    values = struct.pack("<Id", 1, 1.0) + struct.pack("<II", 0, 0)
    assert write(one, "plain") == HEADER + name + values
    # 20 bytes so far: the byte moves the count to 24, and the value, aligned to 8, to 32
    assert write(one, "control_type") == HEADER + name + b"\2\0\0\0" + struct.pack("<I4xd", 1, 1.0) + bytes(8)


def test_the_other_layout_is_noticed_for_the_official_order_of_joints() -> None:
    for control in (1, 2):
        with pytest.raises(LayoutError):
            read(write(message(control), "control_type"), "plain")
    with pytest.raises(LayoutError):
        read(write(message(None), "plain"), "control_type")


@pytest.mark.parametrize(
    ("arrays", "meant"),
    [(([1.0], [], []), 0), (([], [1.0], []), 1), (([0.0], [0.0], [0.5]), 2), (([], [0.0], []), 1), (([], [], []), 0)],
)
def test_what_a_message_without_control_type_means(arrays: tuple[list[float], ...], meant: int) -> None:
    assert JointCmd([b"boom_joint"], None, *arrays).meant == meant
    assert JointCmd([b"boom_joint"], 2, *arrays).meant == 2


@pytest.mark.parametrize(
    "data", [b"", b"\0\1\0\0", b"\1\0\0\0" + bytes(20), HEADER + b"\xff" * 20, HEADER + b"\1\0\0\0" + b"\xff" * 4]
)
def test_garbage_is_refused(data: bytes) -> None:
    for layout in ("plain", "control_type"):
        with pytest.raises(LayoutError):
            read(data, layout)
