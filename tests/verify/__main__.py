"""Entry of `make verify`."""

import sys
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]
sys.path[0:1] = [str(TESTS), str(TESTS / "data")]

from verify.program import main  # noqa: E402

sys.exit(main())
