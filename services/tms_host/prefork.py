"""supervisord whose programs of ours are forks of itself, with the libraries and our common modules already loaded.

A start by `execve` spends most of its time and half of its memory on importing the same once more. A fork shares it,
and supervisord still supervises the real pid. A restarted process always runs the code and configuration that are on
disk now: once a module that is loaded here has changed there, programs are executed, and files of settings are read
anew once their text has. Modules that only some processes run are not loaded here, since their metrics would be
everybody's; decisions have none. Nothing here opens a ROS context, whose threads would not survive the fork (those of
LTTng, which rclpy brings, are not missed).
"""

import ctypes
import gc
import importlib
import logging
import os
import pkgutil
import signal
import sys
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import NoReturn

import pydantic
import setproctitle
from supervisor.options import ProcessConfig, ServerOptions
from supervisor.supervisord import go

import tms_decision
from tms_config.config import load_site
from tms_host.supervisor import AT_ONCE
from tms_reason import wire
from tms_reason.errors import ConfigError

MODULE = "tms_runtime.run"  # programs that are forked; others (none today) are executed as usual
LIBRARIES = (
    "rclpy", "rclpy.action", "rclpy.executors", "rclpy.event_handler", "rclpy.serialization",
    "prometheus_client", "structlog.stdlib", "yaml", "asyncio", "http.client", "concurrent.futures", "logging.handlers",
    "difflib", "babel.messages.pofile", "numpy.typing", "pydantic.networks", "pydantic.type_adapter", "psutil",
)  # fmt: skip
LIBRARIES_OF = {  # of single processes, where they run: a fifth of what each would weigh
    "db": ("pymongo", "lxml.etree"),
    "ts": ("py_trees", "zmq", "msgpack", "flatbuffers", "simpleeval", "lxml.etree"),
    "rp": ("ompl.base", "ompl.geometric", "fcl", "ruckig", "sqlite3"),
    "mc": ("ruckig",),
    "ur": (
        "fastapi", "fastapi.staticfiles", "starlette.middleware.gzip", "pydantic.v1", "uvicorn", "uvicorn.lifespan.on",
        "uvicorn.loops.asyncio", "uvicorn.protocols.http.h11_impl", "anyio._backends._asyncio", "argon2", "sqlite3",
        "lxml.etree",
    ),
}  # fmt: skip
INTERFACES = (
    "tms_msg_ts", "tms_msg_db", "tms_msg_rc", "tms_msg_rp", "tms_msg_host", "tms_msg_if", "tms_msg_ur", "tms_msg_areas",
    "tms_msg_ground", "tms_msg_sp", "control_msgs", "nav2_msgs", "com3_msgs", "diagnostic_msgs", "geometry_msgs",
    "nav_msgs", "sensor_msgs", "std_msgs", "std_srvs", "tf2_msgs", "trajectory_msgs", "visualization_msgs",
)  # fmt: skip
OURS = (  # and all reasons and decisions
    "tms_runtime.run", "tms_runtime.app", "tms_runtime.graph", "tms_kit.subtask_server", "tms_machine.sensing",
)  # fmt: skip
SERVICES = Path(__file__).resolve().parents[1]
MIDDLEWARE = "librmw_fastrtps_cpp.so"
PR_SET_PDEATHSIG = 1
HANDLED = (signal.SIGTERM, signal.SIGINT, signal.SIGQUIT, signal.SIGHUP, signal.SIGCHLD, signal.SIGUSR2)


class Options(ServerOptions):  # type: ignore[misc]
    """supervisord's calls of the operating system, with two of them replaced."""

    parent = 0  # pid of supervisord, in its child
    unloaded = 0  # programs to fork before `load`

    def __init__(self) -> None:
        super().__init__()
        self.loaded: dict[str, tuple[int, int]] = {}  # see `sources`; empty before `load`

    def programs(self) -> list[ProcessConfig]:
        """What supervisord knows of each program."""
        return [one for group in self.process_group_configs for one in group.process_configs]

    def fork(self) -> int:
        self.parent = os.getpid()
        if self.unloaded:
            self.unloaded -= 1
        elif not self.loaded:
            self._load()
        return os.fork()

    def _load(self) -> None:
        """Load what is forked, while a program that shares nothing of it starts on another processor."""
        try:
            load(one.command.split()[-1] for one in self.programs())
        except ImportError as error:
            self.logger.critical(f"a library of all programs cannot be loaded: {error}")
            raise
        self.loaded = sources(ours())
        gc.freeze()  # or the next collection would write to pages that are shared with the forks

    def execve(self, filename: str, argv: list[str], env: dict[str, str]) -> None:
        """Become the program, in the child. supervisord has already set pipes, group and working folder."""
        if argv[1:2] == ["-m"] and argv[2:3] == [MODULE] and sources(self.loaded) == self.loaded:
            exec_entry(argv, env, self.parent)
        super().execve(filename, argv, env)


def exec_entry(argv: list[str], env: dict[str, str], parent: int) -> NoReturn:
    """Run `python -m tms_runtime.run NAME` in this fork, and end with its exit code."""
    gc.freeze()  # supervisord's objects are never collected here: their file numbers belong to other files now
    for number in HANDLED:
        signal.signal(number, signal.SIG_DFL)
    _end_with(parent)
    setproctitle.setproctitle(" ".join(argv))  # before the environment is replaced: setproctitle finds its place there
    os.environ.clear()
    os.environ.update(env)
    sys.argv = argv[2:]
    code = 1
    try:
        code = importlib.import_module(MODULE).main(*argv[3:])
    except BaseException:  # do what the interpreter does at the end of a program
        sys.excepthook(*sys.exc_info())
    logging.shutdown()
    sys.stdout.flush()
    os._exit(code)


def _end_with(parent: int) -> None:
    """End with the parent. Called before any import: a supervisord that is killed meanwhile would leave an orphan."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM, 0, 0, 0)
    if os.getppid() != parent:
        os._exit(1)


def load(processes: Iterable[str]) -> None:
    """Import the libraries of all processes, and those of these single ones: `tms:ur`."""
    for name in LIBRARIES:
        importlib.import_module(name)
    for process in {name.partition(":")[2].partition("_")[0] for name in processes}:
        for name in LIBRARIES_OF.get(process, ()):
            try:
                importlib.import_module(name)
            except ImportError as error:  # the process that needs it fails alone, and is the one to tell why
                sys.stderr.write(f"{name} is not loaded before programs are forked: {error}\n")
    pydantic.create_model("Loaded", name=(str, ...))  # it imports most of itself with the first model
    for package in INTERFACES:
        for kind in ("msg", "srv", "action"):
            _load_types(f"{package}.{kind}")
    ctypes.CDLL(MIDDLEWARE, mode=ctypes.RTLD_GLOBAL)
    decisions = [one.name for one in pkgutil.walk_packages(tms_decision.__path__, "tms_decision.")]
    for name in (*OURS, *decisions):
        importlib.import_module(name)
    with suppress(ConfigError):  # each program tells what is wrong with the site
        load_site()
    wire.load()
    wire.load.cache_clear()  # each process looks for those that were added since


def ours() -> list[str]:
    """The files of our modules that are loaded."""
    files = (getattr(module, "__file__", None) for module in list(sys.modules.values()))
    return [file for file in files if file is not None and file.startswith(f"{SERVICES}/")]


def sources(files: Iterable[str]) -> dict[str, tuple[int, int]]:
    """When each of these files was changed last [ns], and its size [bytes]; none for those that are gone."""
    found = {}
    for file in files:
        with suppress(FileNotFoundError):
            facts = Path(file).stat()
            found[file] = (facts.st_mtime_ns, facts.st_size)
    return found


def _load_types(name: str) -> None:
    try:
        module = importlib.import_module(name)
    except ModuleNotFoundError as missing:
        if missing.name != name:
            raise
        return
    for each in vars(module).values():
        load_support = getattr(type(each), "__import_type_support__", None)
        if load_support is not None:
            each.__import_type_support__()


def main() -> None:
    """Run supervisord with the arguments of the command line."""
    options = Options()
    options.realize(doc=__doc__)
    options.unloaded = sum(one.priority == AT_ONCE and one.autostart for one in options.programs())
    options.first, options.test = True, False
    go(options)


if __name__ == "__main__":
    main()
