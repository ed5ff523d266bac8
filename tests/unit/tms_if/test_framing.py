"""Frames: the bytes of the protocol description, in pieces, and what is no frame."""

import random
import struct

import pytest

from tms_if.framing import Frame, FrameError, Splitter, encode

TWIST = bytes.fromhex(
    "14000000" "7a783230302f747261636b732f636d645f76656c" "34000000" "00010000" "000000000000e03f"
) + bytes(40)  # fmt: skip
SUBSCRIBE = b"__subscribe\0"
JSON = b'{"topic":"zx200/front_cmd","message_name":"com3_msgs/JointCmd"}\0'


def test_the_example_of_the_protocol() -> None:
    payload = b"\0\1\0\0" + struct.pack("<6d", 0.5, 0, 0, 0, 0, 0)
    assert encode("zx200/tracks/cmd_vel", payload) == TWIST
    assert len(TWIST) == 80
    assert Splitter(100).feed(TWIST) == [Frame("zx200/tracks/cmd_vel", payload)]


def test_a_nul_ends_the_simulators_names_and_is_not_part_of_them() -> None:
    data = struct.pack("<I", 12) + SUBSCRIBE + struct.pack("<I", len(JSON)) + JSON
    assert Splitter(1000).feed(data) == [Frame("__subscribe", JSON)]


def test_a_keep_alive() -> None:
    (frame,) = Splitter(10).feed(bytes(8))
    assert frame.keep_alive


@pytest.mark.parametrize("seed", range(5))
def test_pieces_of_any_size(seed: int) -> None:
    rng = random.Random(seed)
    sent = [Frame(f"t{i}", rng.randbytes(rng.randrange(40))) for i in range(50)] + [Frame("", b"")]
    data = b"".join(encode(frame.destination, frame.payload) for frame in sent)
    splitter, found = Splitter(100), []
    while data:
        size = rng.randrange(1, 30)
        found += splitter.feed(data[:size])
        data = data[size:]
    assert found == sent
    assert splitter.pending == 0


@pytest.mark.parametrize(
    ("data", "why"),
    [
        (b"GET / HTTP/1.1\r\n\r\n", "a destination of 542393671 bytes, the limit is 1024: is that a ROS-TCP client?"),
        (b"\xff\xff\xff\xff", "a destination of 4294967295 bytes"),
        (struct.pack("<I", 1) + b"t" + b"\xff\xff\xff\xff", "a message of 4294967295 bytes, the limit is 100"),
        (struct.pack("<I", 2) + b"\xff\xfe" + bytes(4), "a destination that is no text"),
    ],
)
def test_what_is_no_frame_is_known_before_it_is_waited_for(data: bytes, why: str) -> None:
    with pytest.raises(FrameError, match="^" + why.replace("/", ".").replace("?", ".")):
        Splitter(100).feed(data)


def test_half_a_frame_is_kept_and_told() -> None:
    splitter = Splitter(100)
    assert splitter.feed(TWIST[:30]) == []
    assert splitter.pending == 30
