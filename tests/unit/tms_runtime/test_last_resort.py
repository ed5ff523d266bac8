import subprocess
import sys

import pytest

HANGS = """
import ctypes, sys
from tms_runtime.last_resort import end_after
end_after(0.1, int(sys.argv[1]))
ctypes.PyDLL(None).sleep(60)  # native code that keeps the interpreter
"""


@pytest.mark.parametrize("code", [0, 1, 130])
def test_a_process_ends_with_its_code_though_native_code_holds_the_interpreter(code: int) -> None:
    done = subprocess.run([sys.executable, "-c", HANGS, str(code)], timeout=50, check=False)
    assert done.returncode == code
