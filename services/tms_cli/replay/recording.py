"""A recording of ROS 2 (rosbag2) on disk: its topics, and their messages as serialized bytes."""

import struct
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from types import TracebackType
from typing import Any

import apsw
from rosbags.interfaces import MessageDefinition, MessageDefinitionFormat
from rosbags.rosbag2 import Reader, ReaderError
from rosbags.typesys import Stores, get_types_from_idl, get_types_from_msg, get_typestore
from rosbags.typesys.base import TypesysError

from tms_cli.reasons import BadBag
from tms_reason.errors import TmsError

# Errors of the reader for damaged files, since it does not check the lengths and texts in them.
DAMAGED = (
    ReaderError, OSError, apsw.Error, struct.error, OverflowError, MemoryError, ValueError, LookupError, TypeError,
    RuntimeError,
)  # fmt: skip


@dataclass(frozen=True)
class Track:
    """One topic of a recording."""

    topic: str
    type: str  # package/msg/Name
    messages: int
    hash: str  # RIHS01_..., "" where the recording has no layout of the type
    source: Any = field(compare=False)  # the reader's object for the topic


class Recording:
    """An open recording; a context manager."""

    def __init__(self, path: Path) -> None:
        """`path`: the folder with metadata.yaml, or one .db3 or .mcap file.

        Raises:
            TmsError: BAD_BAG; it does not exist, is no recording, is damaged, or is of a kind that cannot be read.
        """
        self.path = path
        if not path.exists():
            raise _bad(f"there is no {path}: give a bag's folder, or its .db3 or .mcap file")
        _check_kind(path)
        try:
            self._reader = Reader(path)
            self._reader.open()
            self.tracks = [_track(one) for one in self._reader.connections]
        except PermissionError as error:
            raise _bad(f"{path} cannot be read ({error.strerror}): check its permissions") from error
        except DAMAGED as error:
            raise self._damaged(error) from error

    def __enter__(self) -> "Recording":
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, _: TracebackType | None) -> None:
        self._reader.close()

    @property
    def span(self) -> tuple[int, int]:
        """First and last moment, ns, clock of the PC that recorded; the same twice when nothing was recorded."""
        return (self._reader.start_time, self._reader.end_time - 1) if self._reader.message_count else (0, 0)

    def messages(self, tracks: Sequence[Track], begin: int, end: int) -> Iterator[tuple[Track, int, bytes]]:
        """Messages from `begin` to before `end` (ns), in the order of recording, each with its moment.

        Raises:
            TmsError: BAD_BAG; the file is damaged from here on.
        """
        by_source = {track.source.id: track for track in tracks}
        try:
            for source, moment, data in self._reader.messages([t.source for t in tracks], begin, end):
                yield by_source[source.id], moment, bytes(data)
        except DAMAGED as error:
            raise self._damaged(error) from error

    def _damaged(self, error: BaseException) -> TmsError:
        said = str(error) or type(error).__name__
        if "version" in said and "not supported" in said:
            return _bad(f"{self.path}: {said.split(';')[0]} here (up to 9): convert it with `ros2 bag convert`")
        return _bad(f"{self.path} is truncated, damaged or no bag ({said}): try `ros2 bag reindex`, or record again")


def _bad(text: str) -> TmsError:
    return TmsError(BadBag(text))


def _check_kind(path: Path) -> None:
    if path.is_dir():
        if not (path / "metadata.yaml").exists():
            files = sorted(one.name for one in path.iterdir() if one.suffix in (".db3", ".mcap"))
            hint = f"give its file {files[0]}" if files else "give the folder that `ros2 bag record` made"
            raise _bad(f"{path} is no bag: it has no metadata.yaml; {hint}")
    elif path.suffix == ".bag":
        raise _bad(f"{path} is a bag of ROS 1: convert it with `rosbags-convert --src {path} --dst FOLDER`")
    elif path.suffix not in (".db3", ".mcap"):
        raise _bad(f"{path} is no bag: give a bag's folder, or its .db3 or .mcap file")


def _track(source: Any) -> Track:
    return Track(source.topic, source.msgtype, source.msgcount, source.digest or _hash(source), source)


def _hash(source: Any) -> str:
    """Hash of the type's definition in the recording; "" where there is none that can be read."""
    definition: MessageDefinition = source.msgdef
    readers = {MessageDefinitionFormat.MSG: get_types_from_msg, MessageDefinitionFormat.IDL: _from_idl}
    if definition.format not in readers or not definition.data.strip():
        return ""
    store = get_typestore(Stores.EMPTY)
    try:
        store.register(readers[definition.format](definition.data, source.msgtype))
        return str(store.hash_rihs01(source.msgtype))
    except (TypesysError, LookupError):
        return ""


def _from_idl(text: str, _: str) -> Any:
    return get_types_from_idl(text)
