"""What is remembered of records is read again, whatever became of the reading before."""

import threading
import time
from collections.abc import Callable
from typing import Any

import pytest

from tms_db.record_cache import KEPT, RecordCache
from tms_db.records import Document
from tms_reason.errors import DbError
from tms_reason.reason import Foreign

KEY = ("zx200", "p")


class Store:
    """Of one record."""

    def __init__(self) -> None:
        self.trouble: Exception | None = None
        self.x = 1

    def get(self, *_: str) -> Document:
        return {"_id": 1, "x": self.x}

    def by_id(self, _: list[Any]) -> list[Document]:
        if self.trouble is not None:
            raise self.trouble
        return [self.get()]


class Ros:
    def on_executor(self, step: Callable[[], None]) -> None:
        step()


class Thread:
    """Runs at once, and ends as a thread does."""

    def __init__(self, target: Callable[..., None], args: tuple[Any, ...], **_: Any) -> None:
        self._work = lambda: target(*args)

    def start(self) -> None:
        try:
            self._work()
        except RuntimeError:
            pass


@pytest.mark.parametrize("trouble", [DbError(Foreign("away"), "STORE_DOWN"), RuntimeError("the client was closed")])
def test_a_reading_that_failed_is_tried_again(trouble: Exception, monkeypatch: pytest.MonkeyPatch) -> None:
    clock = [100.0]
    monkeypatch.setattr(time, "monotonic", lambda: clock[0])
    monkeypatch.setattr(threading, "Thread", Thread)
    stored, ros = Store(), Ros()
    found = RecordCache(stored, lambda key: {}, ros, lambda: False)  # type: ignore[arg-type]
    found.get(KEY)
    stored.x, stored.trouble = 2, trouble
    clock[0] += KEPT + 0.5
    assert found.get(KEY).document["x"] == 1
    stored.trouble = None
    assert found.get(KEY).document["x"] == 2
