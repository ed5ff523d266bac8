"""What tests that start processes share: a ROS domain and ports of their own, a site file, a mesh."""

import fcntl
import os
import re
import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable, Generator, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
import structlog
import yaml

import examples
import programs
import sharing
import turns
from tms_runtime import environment

if TYPE_CHECKING:
    from tms_ros.node import Ros

PROJECT = Path(__file__).resolve().parents[1]
SPOILED = pytest.StashKey[bool]()
RUNNING = pytest.StashKey["Mesh"]()
DOMAINS = range(43, 101)  # 42 is the demo's
CLI = 0.4  # s between two calls of `tms` that wait for something: each costs 0.05 s of a processor
WARNINGS = 40  # lines shown of a failed test's mesh

examples.register()


def on_loopback() -> None:
    """DDS of this process as a mesh on one PC has it. Fast DDS reads its profile once, for the first node of a process:
    a test that made one without it left all later tests of its process with other transports and heartbeats."""
    os.environ.update(environment.ON_LOOPBACK)


def pytest_addoption(parser: pytest.Parser) -> None:
    turns.add_option(parser)


def pytest_configure(config: pytest.Config) -> None:
    """Which turn it is; log lines as `event=name key=value`, through the standard library, where pytest hears them."""
    turns.settle(config)
    on_loopback()
    structlog.configure(
        processors=[structlog.contextvars.merge_contextvars, structlog.processors.LogfmtRenderer(key_order=["event"])],
        logger_factory=structlog.stdlib.LoggerFactory(),
        wrapper_class=structlog.stdlib.BoundLogger,
    )


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> sharing.OneMesh | None:
    """Who does which tests in `--dist loadfile`."""
    return sharing.OneMesh(config, log) if config.getvalue("dist") == "loadfile" else None


def pytest_report_header(config: pytest.Config) -> str:
    return f"turn: {config.option.turn} of {turns.TURNS}"


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """What lasts longest comes first; otherwise the order is random. Some tests come by turns."""
    late = turns.waiting(items, config.option.turn)
    config.hook.pytest_deselected(items=list(late))
    items[:] = [item for item in items if item not in late]
    items.sort(key=sharing.rank)


@contextmanager
def claimed_domain() -> Iterator[int]:
    """A ROS_DOMAIN_ID that no other test on this PC uses meanwhile."""
    for number in DOMAINS:
        with (Path(tempfile.gettempdir()) / f"tms-test-domain-{number}.lock").open("w") as file:
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                continue
            yield number
            return
    pytest.fail("no free ROS domain: other test runs hold all of them")


@pytest.fixture(scope="session")
def domain() -> Iterator[int]:
    """The ROS domain of this test run."""
    with claimed_domain() as number:
        yield number


@pytest.fixture
def own_domain() -> Iterator[int]:
    """A further ROS domain for one test, where nothing of this test run is up."""
    with claimed_domain() as number:
        yield number


@pytest.fixture
def two_nodes(own_domain: int) -> Iterator["tuple[Ros, Ros]"]:
    """Two nodes of this process, each with a context of its own, so that they meet by discovery."""
    from tms_ros.node import Ros

    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(os.environ, "ROS_DOMAIN_ID", str(own_domain))
        server, client = Ros("server"), Ros("client")
    yield server, client
    client.close()
    server.close()


def tool(*names: str) -> str:
    """Path of the first of these programs that is here; without one the test fails: skipped, nobody would miss it."""
    where = os.pathsep.join((os.environ.get("PATH", os.defpath), "/usr/sbin", "/sbin"))
    for name in names:
        if found := shutil.which(name, path=where):
            return found
    pytest.fail(f"{' or '.join(names)} is missing: `make test` (`make test-docker` for tests/docker) installs it")


def ports_of(domain: int) -> int:
    """First of 220 ports that belong to a domain: below those that the system gives to outgoing connections."""
    return 20000 + (domain - DOMAINS.start) * 220


@pytest.fixture(scope="session")
def first_port(domain: int) -> int:
    """First of the ports of the test run's domain."""
    return ports_of(domain)


def site_data(domain: int, port: int, /, **changes: object) -> dict[str, object]:
    """A site like the demo's on other ports, five times as fast."""
    data: dict[str, object] = {
        "name": "test",
        "domain": domain,
        "ports": {"metrics": port + 100, "console": port + 90, "store": port + 91, "groot": port + 60},
        "sim": {"speed": 5.0},
        "services": {"db": {}, "ts": {}, "ur": {}, "sp": {}, "host": {}},
        "machines": {"zx200": {"model": "zx200"}},
    }
    return {**data, **changes}


NO_CONSOLE: dict[str, object] = {"services": {"db": {}, "ts": {}, "host": {}}}  # changes of a site that only runs tasks
GATEWAYS_ONLY: dict[str, object] = {  # changes of a site: machines without scheduler, database and console
    "services": {"host": {}},
    "store": {"kind": "mongodb", "uri": "mongodb://127.0.0.1:1"},
}


@dataclass
class Mesh:
    """A mesh under supervisord and its command line."""

    site: Path
    state: Path

    @property
    def env(self) -> dict[str, str]:
        """Environment of a user of this mesh."""
        hidden = ("ROS_DOMAIN_ID", "TMS_MONGODB_URI", "PYTHONPATH")
        clean = {key: value for key, value in os.environ.items() if key not in hidden}
        return {**clean, "TMS_SITE": str(self.site), "TMS_STATE": str(self.state), "COLUMNS": "200"}

    def environment_of(self, pc: str) -> dict[str, str]:
        """Of the processes of another PC of this site, which has a state folder of its own."""
        from tms_config.config import load_site

        other = {**self.env, "TMS_PC": pc, "TMS_STATE": str(self.state.with_name(pc))}
        with pytest.MonkeyPatch.context() as patch:
            patch.delenv("ROS_DOMAIN_ID", raising=False)  # the site's own counts
            for key, value in other.items():
                patch.setenv(key, value)
            return {**other, **environment.environment(load_site())}

    def tms(self, *words: str, expect: int | None = 0, limit: float = 90) -> subprocess.CompletedProcess[str]:
        """Run the command line; the exit code must be `expect`."""
        done = programs.tms(words, self.env, limit)
        if expect is not None:
            assert done.returncode == expect, f"tms {' '.join(words)}: {done.returncode}\n{done.stdout}\n{done.stderr}"
        return done

    def arm(self) -> None:
        """Re-arm what is latched, as at the first start: no note says how a machine was left."""
        self.wait_ready()
        self.tms("rearm", "--all", "--yes")

    def wait_ready(self) -> None:
        """Until `tms status` says that everything works."""
        wait_until(lambda: self.tms("status", expect=None).returncode == 0, 60, "the mesh is ready again", every=CLI)


@contextmanager
def running(mesh: Mesh, armed: bool = True) -> Iterator[Mesh]:
    """The mesh, up and its machines armed; nothing of it is left afterwards, also when it did not get ready."""
    try:
        mesh.tms("up")
        if armed:
            mesh.arm()
        yield mesh
    finally:
        mesh.tms("down")


@contextmanager
def mesh_apart(folder: Path, **changes: object) -> Iterator[Mesh]:
    """A mesh in a domain of its own, not up yet, whose site and environment are those of this process meanwhile."""
    from tms_config.config import load_site

    with claimed_domain() as domain, pytest.MonkeyPatch.context() as patch:
        site = folder / "site.yaml"
        site.write_text(yaml.safe_dump(site_data(domain, ports_of(domain), **changes)))
        made = Mesh(site, folder / "state")
        for key, value in made.env.items():
            patch.setenv(key, value)
        for key, value in environment.environment(load_site()).items():
            patch.setenv(key, value)
        yield made


@pytest.fixture(scope="session")
def mesh(
    request: pytest.FixtureRequest, domain: int, first_port: int, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Mesh]:
    """A running mesh with a simulated zx200, its records and three tasks; one for the whole test run.

    Tasks: 1 one loading cycle, 2 four of them, 3 many long swings to and fro, 4 a few of these, 5 one move.
    """
    folder = tmp_path_factory.mktemp("mesh")
    site = folder / "site.yaml"
    site.write_text(yaml.safe_dump(site_data(domain, first_port)))
    with running(Mesh(site, folder / "state")) as made:
        made.tms("param", "load", "configs/parameters/zx200.yaml")
        made.tms("task", "add", "configs/tasks/one_loading_cycle.xml")
        made.tms("task", "add", "configs/tasks/four_loading_cycles.xml")
        made.tms("param", "load", str(PROJECT / "tests" / "data" / "swings.yaml"))
        for name in ("many_swings", "few_swings", "one_move"):
            made.tms("task", "add", str(PROJECT / "tests" / "data" / f"{name}.xml"))
        request.session.stash[RUNNING] = made
        yield made


@pytest.hookimpl(trylast=True)
def pytest_runtest_teardown(item: pytest.Item, nextitem: pytest.Item | None) -> None:
    """End the mesh of the test run after its last test: while it waits, others go on slower."""
    last = nextitem is None or not sharing.uses_mesh(nextitem.path)
    if last and (made := item.session.stash.get(RUNNING, None)) is not None:
        del item.session.stash[RUNNING]
        made.tms("down")


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Remember that the mesh of the test run may be in disorder, and show what its processes warned of."""
    report = yield
    if report.failed and "mesh" in getattr(item, "fixturenames", ()):
        item.session.stash[SPOILED] = True
    if report.failed:
        for mesh in (value for value in getattr(item, "funcargs", {}).values() if isinstance(value, Mesh)):
            report.sections.append((f"last warnings of {mesh.state}", warnings_of(mesh)))
    return report


def warnings_of(mesh: Mesh) -> str:
    """The last warnings and errors of all processes of a mesh, in the order of their times."""
    texts = (path.read_text(errors="replace") for path in (mesh.state / "log").glob("*.log"))
    lines = (line for text in texts for line in text.splitlines() if re.search(" (WARNING|ERROR) ", line[:50]))
    return "\n".join(sorted(lines)[-WARNINGS:])


@pytest.fixture(autouse=True)
def order(request: pytest.FixtureRequest) -> None:
    """After a failed test: a machine that it left latched, or a run, must not fail the others, too."""
    if "mesh" in request.fixturenames and request.session.stash.get(SPOILED, False):
        mesh = request.getfixturevalue("mesh")
        if isinstance(mesh, Mesh):  # and not one that a module has of its own
            request.session.stash[SPOILED] = False
            mesh.tms("cancel", "last", expect=None)
            mesh.tms("rearm", "zx200", "--yes", expect=None)


@pytest.fixture(scope="session")
def node(mesh: Mesh) -> Iterator["Ros"]:
    """A ROS node of the test run in the domain of the mesh."""
    with node_in(mesh) as inside:
        yield inside


@contextmanager
def node_in(mesh: Mesh) -> Iterator["Ros"]:
    """A ROS node in the domain of a mesh."""
    from tms_config.config import load_site
    from tms_ros.node import Ros

    old = dict(os.environ)
    os.environ.update(mesh.env)
    try:
        environment.enter(load_site())
        inside = Ros("tms_tests")
    finally:
        os.environ.clear()
        os.environ.update(old)
    yield inside
    inside.close()


def rearm(ros: "Ros", machine: str) -> bool:
    """Both steps of a re-arm, as one person takes them; whether the machine is armed then.

    A request to a gateway that was killed just now may be lost: it stays in the graph for a while. That is no failure.
    """
    from tms_msg_rc.srv import Rearm

    from tms_reason.errors import RosError
    from tms_ros.reasons import NoAnswer

    try:
        token = ros.call(Rearm, f"/{machine}/rearm", Rearm.Request(), 8).token
        return bool(ros.call(Rearm, f"/{machine}/rearm", Rearm.Request(token=token), 8).armed)
    except RosError as error:
        if error.reason.find(NoAnswer) is None:
            raise
        return False


def wait_until(holds: Callable[[], bool], seconds: float, what: str | Callable[[], str], every: float = 0.02) -> None:
    """Poll until something holds; fails the test with `what` (made then, where it is a function) when it does not."""
    deadline = time.monotonic() + seconds
    while not holds():
        assert time.monotonic() < deadline, f"not within {seconds} s: {what if isinstance(what, str) else what()}"
        time.sleep(every)
