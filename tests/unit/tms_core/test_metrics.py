"""The health port of a process."""

import socket
from typing import Any

import pytest

from tms_core import metrics


def test_it_opens_without_asking_a_name_server(monkeypatch: pytest.MonkeyPatch) -> None:
    """A site's network may have none; each question would last for seconds."""

    def ask(*_names: Any) -> str:
        pytest.fail("a name server was asked")

    for name in ("getfqdn", "gethostbyaddr", "gethostbyname"):
        monkeypatch.setattr(socket, name, ask)
    health = metrics.Health("127.0.0.7", 29411, unready=lambda: "busy")
    try:
        assert metrics.unready("127.0.0.7", 29411) == "busy"
    finally:
        health.close()
