"""The process table: services + machines x subtasks. No other part starts processes."""

import difflib
from collections import Counter
from dataclasses import dataclass, replace

from tms_config import reasons
from tms_config.config import CONFIGS, Site
from tms_config.models import MachineModel
from tms_config.site_file import Bridge, Role, roles
from tms_config.yaml_file import located
from tms_reason.errors import ConfigError

SERVICES = ("db", "sp", "ts", "ur", "if", "host")  # their packages, without `tms_`
PURPOSES = {  # what they and the other processes are for; `tms ps` shows it in the language of the user
    "db": "tasks, parameters and history in MongoDB",
    "sp": "sensing topics into dynamic parameters",
    "ts": "runs tasks: the behaviour-tree scheduler",
    "ur": "HTTP API and console",
    "if": "TCP bridge that OperaSim-PhysX connects to",
    "host": "processes of this PC",
    "ground": "soil: what machines dig, carry and tip",
    "store": "embedded store of the demo",
    "discovery": "lets the PCs' processes find each other",
    "sim": "stand-in for {machine}",
    "scanners": "stand-in for scanners of the ground",
    "trackers": "stand-in for trackers of people and vehicles",
    "operasim": "stand-in for OperaSim-PhysX",
    "rc": "gateway: every motion passes it",
    "readers": "templates and records for the C++ system's version 6",
    "peers": "passes goals of the C++ system's version 6 on",
    "mc": "moves joints and tracks",
    "rp": "plans motions",
    "subtask": "subtask {file}",
}


@dataclass(frozen=True)
class Process:
    """One row: a supervised process."""

    group: str
    name: str
    role: Role
    module: str  # has start(app)
    port: int  # of its metrics and health
    purpose: str  # one of PURPOSES
    machine: str | None = None
    action: str | None = None  # a subtask's action name
    autostart: bool = True
    pc: str = ""  # which PC of the site runs it; empty when there is one only
    address: str = "127.0.0.1"  # where its port is
    form: str = ""  # of an interface package, in place of the usual one (tms_runtime/wire_form.py)
    ours: bool = True  # has metrics and health, which foreign programs do not have

    @property
    def full(self) -> str:
        """Name that supervisord and `tms ps` show."""
        return f"{self.group}:{self.name}"


def table(site: Site) -> tuple[Process, ...]:
    """All processes of a site, in start order, each with its own metrics port.

    Raises:
        ConfigError: a service or subtask that does not exist, or two rows with one name.
    """
    rows = [*_services(site), *(row for machine in site.file.machines for row in _machine(site, machine))]
    base = site.file.ports.metrics
    numbered = tuple(_placed(site, replace(row, port=base + i)) for i, row in enumerate(rows))
    for name, count in Counter(row.full for row in numbered).items():
        if count > 1:
            raise ConfigError(reasons.BadFile(str(site.path), reasons.SameName(name)))
    return numbered


def here(site: Site) -> tuple[Process, ...]:
    """The rows that this PC runs.

    Raises:
        ConfigError: as `table`; or it is not known which PC of the site this is.
    """
    site.require_pc()
    return tuple(row for row in table(site) if not row.pc or row.pc == site.pc)


def find(site: Site, name: str) -> Process:
    """The row with this name; a part of the name is enough when only one row matches.

    Raises:
        ConfigError: no row or several match; names them.
    """
    rows = table(site)
    if exact := [row for row in rows if row.full == name]:
        return exact[0]
    group, _, part = name.rpartition(":")
    near = [row for row in rows if part and part in row.name and group in ("", row.group)]
    plain = [row for row in near if row.name.endswith(part)]
    hits = plain if len(plain) == 1 else near
    if len(hits) == 1:
        return hits[0]
    if hits:
        raise ConfigError(reasons.SeveralProcesses(name, tuple(row.full for row in hits)))
    close = difflib.get_close_matches(name, [row.full for row in rows], 1, 0.5)
    raise ConfigError(reasons.ProcessMeant(name, close[0]) if close else reasons.NoProcess(name))


def _placed(site: Site, row: Process) -> Process:
    pc = row.pc or _place(site, row)
    return replace(row, pc=pc, address=site.file.pcs[pc].address if pc else site.file.bind)


def _place(site: Site, row: Process) -> str:
    """Name of the PC that runs a process; empty when the site is one PC.

    Raises:
        ConfigError: no PC, or more than one, would run it.
    """
    known = site.file.pcs
    able = [name for name, pc in known.items() if row.role in roles(name, pc)]
    named = [name for name in able if row.machine in known[name].machines]
    fit = named or [name for name in able if not known[name].machines]
    if not known:
        return ""
    if len(fit) != 1:
        problem = reasons.ManyPcsFor(tuple(fit), row.full, row.role) if fit else reasons.NoPcFor(row.full, row.role)
        raise ConfigError(located(site.path, problem, "pcs"))
    return fit[0]


def _services(site: Site) -> list[Process]:
    rows = []
    if site.embedded_store:
        rows.append(Process("tms", "store", "cps", "tms_host.store", 0, PURPOSES["store"], ours=False))
    if site.file.network.discovery == "server":
        rows.append(Process("tms", "discovery", "cps", "tms_host.discovery", 0, PURPOSES["discovery"], ours=False))
    data = site.file.forms.TmsdbGetData
    if data or any(map(site.other_form, site.file.peers)):  # for templates both forms are the same
        form = data or "both"
        rows.append(Process("tms", "if_readers", "cps", "tms_if.reader_border", 0, PURPOSES["readers"], form=form))
    if site.file.ground is not None:
        rows.append(Process("tms", "ground", "cps", "tms_ground.node", 0, PURPOSES["ground"]))
        if site.file.backend == "sim" and site.file.sim.scanners:
            rows.append(Process("sim", "scanners", "sim", "tms_sim.scanners", 0, PURPOSES["scanners"]))
    if site.file.backend == "sim" and site.file.sim.trackers:
        rows.append(Process("sim", "trackers", "sim", "tms_sim.trackers", 0, PURPOSES["trackers"]))
    for name, service in site.file.services.items():
        if name not in SERVICES:
            raise ConfigError(located(site.path, reasons.NoService(name, SERVICES), "services", name))
        row = Process("tms", name, service.role, f"tms_{name}.node", 0, PURPOSES[name])
        several = site.file.pcs.items() if name == "host" else ()
        if isinstance(service, Bridge) and service.trial:
            rows.append(Process("sim", "operasim", "sim", "tms_if.trial", 0, PURPOSES["operasim"], ours=False))
        rows += [replace(row, name=f"host_{pc}", role=roles(pc, facts)[0], pc=pc) for pc, facts in several] or [row]
        at = [pc for pc, facts in site.file.pcs.items() if name == "ts" and "scheduler" in roles(pc, facts)]
        rows += [replace(row, name=f"ts_{pc}", role="scheduler", pc=pc) for pc in at]
        for one in (one for one in site.file.machines if sum(one in site.file.pcs[pc].machines for pc in at) > 1):
            raise ConfigError(located(site.path, reasons.ManyPcsFor(tuple(at), f"tasks of {one}", "scheduler"), "pcs"))
    return rows


def _machine(site: Site, machine: str) -> list[Process]:
    use, model = site.file.machines[machine], site.model_of(machine)
    rows = []
    if site.file.backend == "sim":
        rows.append(Process("sim", machine, "sim", "tms_sim.node", 0, PURPOSES["sim"], machine))
    rows.append(Process(machine, "rc", use.role, "tms_rc.node", 0, PURPOSES["rc"], machine))
    if form := site.other_form(machine):
        rows.append(Process(machine, "if", use.role, "tms_if.leaf_border", 0, PURPOSES["peers"], machine, form=form))
    if site.border(machine).controller == "ours":
        rows.append(Process(machine, "mc", use.role, "tms_mc.node", 0, PURPOSES["mc"], machine))
    if model.planner is not None:
        _require(site, machine, f"tms_rp/kinds/{model.planner}/__init__.py", "planner")
        form = "plans" if site.file.forms.TmsRpExcavator == "plans" else ""
        rows.append(Process(machine, "rp", use.role, "tms_rp.node", 0, PURPOSES["rp"], machine, form=form))
    rows += [_subtask(site, machine, model, action) for action in model.subtasks]
    return rows


def _subtask(site: Site, machine: str, model: MachineModel, action: str) -> Process:
    file = model.subtask(action).run
    _require(site, machine, f"tms_subtasks/{file}.py", "subtasks", action)
    return Process(
        machine, action, site.file.machines[machine].role, "tms_kit.subtask_server", 0,
        PURPOSES["subtask"], machine, action, autostart=False,
    )  # fmt: skip


def _require(site: Site, machine: str, path: str, *keys: str) -> None:
    """Refuse a machine file that names a file of ours which does not exist."""
    if not (CONFIGS.parent / "services" / path).exists():
        where = CONFIGS / "machines" / f"{site.file.machines[machine].model}.yaml"
        raise ConfigError(located(where, reasons.NoCodeFile(path), *keys))
