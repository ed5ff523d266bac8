"""`make console-types`: the API's types for the console, from its OpenAPI document."""

import subprocess
from pathlib import Path

from conftest import PROJECT
from unit.tms_ur.fakes import Client, FakeSiteClient, app

FILE = PROJECT / "services" / "tms_ur" / "console" / "src" / "api.ts"
ENVIRONMENT = PROJECT / ".venv-console"


def types() -> str:
    """The text of the file as it must be now."""
    document = Client(app(FakeSiteClient())).get("/openapi.json").text
    node, maker = ENVIRONMENT / "bin" / "node", ENVIRONMENT / "node_modules" / "openapi-typescript" / "bin" / "cli.js"
    words = [str(node), str(maker)]
    return subprocess.run(words, input=document, capture_output=True, text=True, check=True, timeout=120).stdout


def write(file: Path = FILE) -> None:
    """Make the file anew."""
    file.write_text(types(), encoding="utf-8")


if __name__ == "__main__":
    write()
