"""Every Python process of the build loads this: the generators need half the time, and make the same.

The six generators of rosidl each parse all interfaces of their package, with a slow grammar; and for each message they
scan the same templates. With this an interface is parsed once, and a template is scanned once in a process.
"""

import os
import pickle  # noqa: TID251  # only of what this build has written
import sys
from functools import cache
from hashlib import sha256
from pathlib import Path
from typing import Any


def parse_once(parser: Any, folder: Path) -> None:
    """Let a generator take what another has parsed; a folder of this build keeps it."""
    parse = parser.parse_idl_string

    def parsed(text: str, png_file: str | None = None) -> Any:
        kept = folder / sha256(text.encode()).hexdigest()
        if kept.exists():
            return pickle.loads(kept.read_bytes())
        content = parse(text, png_file)
        own = kept.with_suffix(f".{os.getpid()}")  # generators run side by side
        own.write_bytes(pickle.dumps(content))
        own.rename(kept)
        return content

    folder.mkdir(exist_ok=True)
    parser.parse_idl_string = parsed


def scan_once(em: Any) -> None:
    """Let empy keep the tokens of a template, which have no state."""

    @cache
    def tokens(prefix: str, text: str) -> list[Any]:
        scanner, found = em.Scanner(prefix, text), list[Any]()
        while True:
            try:
                token = scanner.one()
            except em.TransientParseError:  # an expansion at the end: empy needs something behind it
                if scanner.rest().endswith("\n"):
                    raise
                scanner.feed(f"{prefix}\n")
                token = scanner.one()
            if token is None:
                return found
            found.append(token)

    def string(self: Any, data: str, name: object = "<string>", locals: object = None) -> None:
        self.contexts.push(em.Context(name))
        for token in tokens(self.prefix, data):
            token.run(self, locals)
        self.contexts.pop()

    em.Interpreter.string = string


if Path(sys.orig_argv[1] if len(sys.orig_argv) > 1 else "").name.startswith("rosidl_"):
    import em
    from rosidl_parser import parser

    parse_once(parser, Path(os.environ["TMS_PARSED"]))
    scan_once(em)
