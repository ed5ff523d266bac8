"""A real Prometheus over a rendered folder, for tests."""

import json
import subprocess
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from urllib.parse import quote

from conftest import tool, wait_until


def get(url: str) -> str:
    with urllib.request.urlopen(url, timeout=5) as answer:
        text: str = answer.read().decode()
    return text


@contextmanager
def prometheus(folder: Path, port: int) -> Iterator[str]:
    """A Prometheus that looks every second instead of every five; its address."""
    config = folder / "prometheus.yml"
    hurried = config.read_text().replace("_interval: 5s", "_interval: 1s").replace("_timeout: 3s", "_timeout: 1s")
    config.write_text(hurried)
    address = f"127.0.0.1:{port}"
    words = [tool("prometheus"), f"--config.file={config}", f"--storage.tsdb.path={folder}/data"]
    with (folder / "log").open("w") as log:
        running = subprocess.Popen([*words, f"--web.listen-address={address}"], stdout=log, stderr=log)
        try:
            wait_until(lambda: answers(f"http://{address}/-/ready"), 30, "Prometheus is ready")
            yield f"http://{address}"
        finally:
            running.terminate()
            running.wait(20)


def answers(url: str) -> bool:
    try:
        get(url)
    except OSError:
        return False
    return True


def query(address: str, expression: str) -> list[dict[str, Any]]:
    """The samples of an expression."""
    found: list[dict[str, Any]] = json.loads(get(f"{address}/api/v1/query?query={quote(expression)}"))["data"]["result"]
    return found


def processes_up(address: str) -> set[str]:
    """Names of the processes that were scraped."""
    return {row["metric"]["process"] for row in query(address, 'up{job="tms"} == 1')}
