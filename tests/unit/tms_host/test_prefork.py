"""A program that is forked sees what an executed one would see: arguments, environment, signals, exit code."""

import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

from conftest import PROJECT
from tms_host.supervisor import AT_ONCE

PROGRAM = """
import os, signal, sys

def main(name):
    if name == "broken":
        raise RuntimeError("no such luck")
    print(name, sys.argv, sorted(os.environ), signal.getsignal(signal.SIGTERM) is signal.SIG_DFL)
    return 3
"""
FORK = """
import os, signal, time
from tms_host import prefork

prefork.MODULE = "program"
signal.signal(signal.SIGTERM, signal.SIG_IGN)
options = prefork.Options()
options.loaded = prefork.sources([{file!r}])
{meanwhile}
parent = os.getpid()
child = options.fork()
if child:
    os._exit({parent})
while {orphan} and os.getppid() == parent:
    time.sleep(0.01)
options.execve("/nonexistent/python", ["python", "-m", {module!r}, {name!r}], {{"ONLY": "this"}})
"""
LOAD = "from tms_host import prefork; prefork.load(f'tms:{name}_east' for name in prefork.LIBRARIES_OF)"
WAITS = "os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])"
START = """
import ctypes
from tms_runtime import run
from tms_reason.reason import Foreign
from tms_reason.errors import ConfigError

def load_site():
    signal = ctypes.c_int()
    ctypes.CDLL(None).prctl(2, ctypes.byref(signal), 0, 0, 0)  # PR_GET_PDEATHSIG
    raise ConfigError(Foreign(f"ends with signal {signal.value}"))

run.load_site = load_site
run.main("tms:db")
"""


@pytest.fixture
def run(tmp_path: Path):  # type: ignore[no-untyped-def]
    (tmp_path / "program.py").write_text(PROGRAM)

    def exec_entry(
        name: str, module: str = "program", parent: str = WAITS, meanwhile: str = ""
    ) -> subprocess.CompletedProcess[str]:
        file = str(tmp_path / "program.py")
        code = f"import sys; sys.path.insert(0, {str(tmp_path)!r})" + textwrap.dedent(
            FORK.format(module=module, name=name, parent=parent, orphan=parent != WAITS, file=file, meanwhile=meanwhile)
        )
        return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=False)

    return exec_entry


def test_it_runs_as_if_it_had_been_executed(run) -> None:  # type: ignore[no-untyped-def]
    done = run("zx200:rc")
    assert done.returncode == 3
    assert done.stdout == "zx200:rc ['program', 'zx200:rc'] ['ONLY'] True\n"


def test_an_exception_leaves_its_traceback_and_exit_code_1(run) -> None:  # type: ignore[no-untyped-def]
    done = run("broken")
    assert done.returncode == 1
    assert "RuntimeError: no such luck" in done.stderr
    assert "Traceback" in done.stderr


def test_nothing_runs_when_supervisord_was_killed_meanwhile(run) -> None:  # type: ignore[no-untyped-def]
    done = run("zx200:rc", parent="0")
    assert (done.stdout, done.stderr) == ("", "")


def test_a_program_ends_with_supervisord_from_its_first_step_on() -> None:
    done = subprocess.run([sys.executable, "-c", START], capture_output=True, text=True, timeout=60, check=True)
    assert done.stderr == "tms:db: ends with signal 15\n"


def test_other_programs_are_executed(run) -> None:  # type: ignore[no-untyped-def]
    done = run("x", module="other")
    assert "FileNotFoundError" in done.stderr  # no such file: an exec was tried


@pytest.mark.parametrize("change", ["touch()", "unlink()", "write_text('')"])
def test_a_program_is_executed_once_a_loaded_module_has_changed(run, change: str) -> None:  # type: ignore[no-untyped-def]
    """What a restarted process runs must come from the disk, not from a supervisord that is weeks old."""
    done = run("zx200:rc", meanwhile=f"from pathlib import Path; Path(*options.loaded).{change}")
    assert "FileNotFoundError" in done.stderr  # no such file: an exec was tried


SUPERVISORD = """
import os, sys
from tms_host import prefork

def fork(own):
    if own.fork() == 0:
        os._exit(0)

def go(own):
{does}

prefork.go = go
prefork.main()
"""


def supervisord(folder: Path, does: str) -> str:
    """What supervisord of a store and a gateway prints, if this is what it does once it knows its programs."""
    conf = folder / "supervisord.conf"
    programs = "".join(
        f"[program:{name.partition(':')[2]}]\ncommand=python -m tms_runtime.run {name}\npriority={priority}\n"
        for name, priority in (("zx200:rc", 999), ("tms:store", AT_ONCE))
    )
    conf.write_text(f"[supervisord]\nlogfile={folder}/log\n{programs}")
    code = SUPERVISORD.format(does=textwrap.indent(textwrap.dedent(does), "    "))
    words = [sys.executable, "-c", code, "-c", str(conf)]
    return subprocess.run(words, capture_output=True, text=True, timeout=60, check=True).stdout


def test_supervisord_knows_the_files_of_the_modules_that_it_has_loaded(tmp_path: Path) -> None:
    printed = supervisord(tmp_path, "fork(own)\nfork(own)\nprint(*own.loaded, sep='\\n')")
    loaded = {str(Path(file).relative_to(PROJECT / "services")) for file in printed.splitlines()}
    assert {"tms_runtime/run.py", "tms_ros/node.py", "tms_kit/subtask_server.py", "tms_rc/reasons.py"} <= loaded


def test_the_store_starts_while_the_libraries_of_the_others_are_loaded(tmp_path: Path) -> None:
    does = """
        for _ in range(3):
            fork(own)
            print(bool(own.loaded), "tms_kit.subtask_server" in sys.modules)
        """
    assert supervisord(tmp_path, does) == "False False\nTrue True\nTrue True\n"


def test_a_library_of_all_that_is_missing_is_in_the_log_of_supervisord(tmp_path: Path) -> None:
    does = """
        own.make_logger()
        prefork.LIBRARIES = ("no_such_library",)
        fork(own)
        try:
            fork(own)
        except ImportError:
            print("ends")
        """
    assert supervisord(tmp_path, does) == "ends\n"
    told = "a library of all programs cannot be loaded: No module named 'no_such_library'"
    assert told in (tmp_path / "log").read_text()


def modules(code: str) -> set[str]:
    """Names of the modules that a program has imported when it ends."""
    done = subprocess.run(
        [sys.executable, "-c", f"{code}; import sys; print(*sys.modules)"],
        cwd=PROJECT / "services", capture_output=True, text=True, timeout=60, check=True,
    )  # fmt: skip
    return set(done.stdout.split())


def imported(code: str) -> set[str]:
    """Names of their packages."""
    return {one.partition(".")[0] for one in modules(code)}


def test_what_only_some_processes_run_is_not_shared() -> None:
    """Its metrics would be those of all processes."""
    loaded = {name for name in modules(LOAD) if name.startswith("tms_")}
    parts = tuple(f"tms_{name}." for name in ("db", "if", "mc", "rc", "rp", "sim", "sp", "subtasks", "ts", "ur"))
    assert "tms_runtime.run" in loaded
    assert {name for name in loaded if name.startswith(parts) and not name.endswith("reasons")} == set()


def test_what_each_process_imports_is_loaded_before_it_is_forked() -> None:
    """Else each keeps a copy of its own of the same libraries, and a start takes longer."""
    loaded = imported(LOAD)
    nodes = ", ".join(f"tms_{name}.node" for name in ("db", "host", "if", "mc", "rc", "rp", "sp", "ts", "ur"))
    needed = imported(f"import tms_runtime.run, tms_runtime.app, tms_runtime.graph, tms_kit.subtask_server, {nodes}")
    assert {one for one in needed - loaded if not one.startswith(("tms_", "_"))} - sys.stdlib_module_names == set()


def test_decisions_of_gateways_and_runs_are_loaded_before_they_are_forked() -> None:
    """Their many small classes are most of what a gateway would still import."""
    needed = {one for one in modules("import tms_rc.node, tms_ts.node") if one.startswith("tms_decision.")}
    assert needed and needed - modules(LOAD) == set()


def test_what_no_process_of_a_pc_needs_is_not_loaded() -> None:
    loaded = imported("from tms_host import prefork; prefork.load(['zx200:rc', 'tms:db'])")
    assert "pymongo" in loaded and not {"ompl", "py_trees", "fastapi"} & loaded


def test_a_library_that_is_broken_keeps_no_other_process_from_its_start() -> None:
    code = (
        "from tms_host import prefork; prefork.LIBRARIES_OF = {'rp': ('no_such_planner',)}; prefork.load(['zx200:rp'])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=True)
    assert "no_such_planner is not loaded before programs are forked: No module named" in done.stderr


def test_the_ground_needs_no_libraries_of_surveyors_to_start() -> None:
    """Only a design in a file does: they take as long as all the rest of a start."""
    needed = imported("import tms_ground.node")
    assert "tms_soil" in needed and not {"laspy", "pyproj", "lxml"} & needed
