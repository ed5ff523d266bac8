"""Entry of `make bench`."""

import sys
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]
sys.path[0:1] = [str(TESTS), str(TESTS.parent / "services")]  # not this folder: its files are named like anything

from bench.runner import main  # noqa: E402

sys.exit(main())
