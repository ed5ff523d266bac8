"""Blackboards: typed entries, shared with a parent blackboard through remaps.

The first port that names a key decides its type ("strong"); an entry without a type ("weak") takes any value.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from tms_ts.bt.convert import CPP_NAMES, FROM_TEXT, MISSING, Missing, kind_of
from tms_ts.bt.errors import TickError, TreeError
from tms_ts.tree_reasons import KeyCannotBecome, KeyOfAnotherType, KeysKeepTypes, TextDoesNotFitKey, UseAnotherKey


class Entry:
    """One value; the same object stands in every blackboard that shares the key."""

    __slots__ = ("has_converter", "kind", "value", "varies")

    def __init__(self, kind: Any, *, has_converter: bool) -> None:
        self.kind = kind  # Any: weak
        self.has_converter = has_converter
        self.value: Any = MISSING
        self.varies = False  # a node may write it


class Blackboard:
    """Entries by key, and the keys that are ports to the blackboard of the calling tree."""

    __slots__ = ("_auto", "_entries", "_keep_private", "_parent", "_remaps")

    def __init__(self, parent: Blackboard | None = None) -> None:
        self._entries: dict[str, Entry] = {}
        self._parent = parent
        self._remaps: dict[str, str] = {}
        self._auto = False
        self._keep_private = False

    def remap(self, inner: str, outer: str) -> None:
        self._remaps[inner] = outer

    def remap_all(self, *, but_private: bool = False) -> None:
        self._auto, self._keep_private = True, but_private

    def _outer(self, key: str) -> str | None:
        if self._parent is None:
            return None
        outer = self._remaps.get(key)
        if outer is None and self._auto and not (self._keep_private and key.startswith("_")):
            return key
        return outer

    def find(self, key: str) -> Entry | None:
        entry = self._entries.get(key)
        if entry is not None or self._parent is None:
            return entry
        outer = self._outer(key)
        return None if outer is None else self._parent.find(outer)

    def touch(self, key: str, kind: Any, *, has_converter: bool) -> Entry:
        """The entry of a key, made (here, or at the far end of its remap) if there is none."""
        entry = self._entries.get(key)
        if entry is None:
            outer = self._outer(key)
            if outer is None or self._parent is None:
                entry = Entry(kind, has_converter=has_converter)
            else:
                entry = self._parent.touch(outer, kind, has_converter=has_converter)
            self._entries[key] = entry
        return entry

    def declare(self, key: str, kind: Any) -> None:
        """Make the entry of a key that a port points at, when the tree is loaded."""
        known = self.find(key)
        entry = self.touch(key, kind, has_converter=True)
        if known is None or Any in (entry.kind, kind) or entry.kind in (kind, str):
            return
        raise TreeError(KeyOfAnotherType(key, CPP_NAMES[entry.kind], CPP_NAMES[kind]), hint=UseAnotherKey())

    def place(self, key: str) -> tuple[int, str]:
        """What identifies a key in the tree: its name at the far end of all remaps, and the blackboard there."""
        outer = self._outer(key)
        return (id(self), key) if outer is None or self._parent is None else self._parent.place(outer)

    def get(self, key: str) -> Any:
        entry = self.find(key)
        return MISSING if entry is None else entry.value

    def constant(self, key: str) -> Any:
        """The value that a key has before the first tick and keeps; MISSING if it is known only during the run."""
        entry = self.find(key)
        return MISSING if entry is None or entry.varies else entry.value

    def vary(self, key: str) -> None:
        """Mark the entry of a key, if there is one, as written by a node."""
        entry = self.find(key)
        if entry is not None:
            entry.varies = True

    def set(self, key: str, value: Any, kind: Any = None) -> None:
        """Write by the library's typing rules; `kind` is the type of the port that writes."""
        kind = kind_of(value) if kind in (None, Any) else kind
        known = self.find(key)
        entry = self.touch(key, Any if kind is str else kind, has_converter=False)
        if known is None or entry.kind in (Any, kind):
            entry.value = value
            return
        if kind is not str or not entry.has_converter:
            raise TickError(KeyCannotBecome(key, CPP_NAMES[entry.kind], CPP_NAMES[kind]), hint=KeysKeepTypes())
        converted = FROM_TEXT[entry.kind](value)
        if isinstance(converted, Missing):
            raise TickError(TextDoesNotFitKey(str(value), key, CPP_NAMES[entry.kind]))
        entry.value = converted

    def copy(self, source: str, target: str) -> None:
        """Copy value and type of one entry to another, without any check."""
        origin = self.find(source)
        if origin is None:
            return
        self.touch(target, origin.kind, has_converter=origin.has_converter).value = origin.value

    def replace(self, key: str, value: Any) -> bool:
        """Write by the same rules, but change the key's type where they refuse the value; True if it was changed."""
        try:
            self.set(key, value)
        except TickError:
            kind = kind_of(value)
            entry = self.touch(key, kind, has_converter=False)
            entry.kind, entry.has_converter, entry.value = kind, False, value
            return True
        return False

    def items(self) -> Iterator[tuple[str, Any]]:
        """Keys of this blackboard that have a value; may be called while another thread ticks."""
        return ((key, entry.value) for key, entry in list(self._entries.items()) if entry.value is not MISSING)
