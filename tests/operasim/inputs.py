"""What a machine does with the messages that it hears. Pure."""

from collections.abc import Callable

from operasim.machine import Machine
from operasim.messages import (
    Layout,
    read_bool,
    read_double,
    read_doubles,
    read_joint_cmd,
    read_joint_state,
    read_twist,
)
from operasim.model import Input, InputKind

Taken = Callable[[Machine, Input, bytes, float, Layout], None]


def take(machine: Machine, one: Input, message: bytes, now: float, layout: Layout) -> None:
    """Take a message, at a frame of the simulator.

    Raises:
        CdrError: it is damaged, or has the other layout.
        IndexError: it has less values than names.
    """
    TAKEN[one.kind](machine, one, message, now, layout)


def _twist(machine: Machine, _one: Input, message: bytes, _now: float, _layout: Layout) -> None:
    machine.tracks.twist(*read_twist(message))


def _track_cmd(machine: Machine, _one: Input, message: bytes, _now: float, layout: Layout) -> None:
    names, _, velocities = read_joint_cmd(message, layout)
    machine.track_cmd({name: velocities[i] for i, name in enumerate(names)})


def _joint_cmd(machine: Machine, _one: Input, message: bytes, now: float, layout: Layout) -> None:
    names, positions, _ = read_joint_cmd(message, layout)
    machine.joint_cmd(names, positions, now)


def _emg_stop(machine: Machine, _one: Input, message: bytes, _now: float, _layout: Layout) -> None:
    machine.emg_stop(read_bool(message))


def _angle(machine: Machine, one: Input, message: bytes, _now: float, _layout: Layout) -> None:
    machine.angle(str(one.joint), read_double(message))


def _angles(machine: Machine, _one: Input, message: bytes, _now: float, _layout: Layout) -> None:
    names, positions = read_joint_state(message)
    for i, name in enumerate(names):
        machine.angle(name, positions[i])


def _drive_params(machine: Machine, one: Input, message: bytes, _now: float, _layout: Layout) -> None:
    values = read_doubles(message)
    machine.drive_params(str(one.joint), values[0], values[1])


TAKEN: dict[InputKind, Taken] = {
    "twist": _twist, "track_cmd": _track_cmd, "joint_cmd": _joint_cmd, "emg_stop": _emg_stop, "angle": _angle,
    "angles": _angles, "drive_params": _drive_params,
}  # fmt: skip
