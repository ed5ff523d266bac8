"""The chosen site with its machine models, checked: see `load_site`."""

import os
from dataclasses import dataclass
from pathlib import Path

from tms_config import reasons
from tms_config.models import Backend, Border, MachineModel
from tms_config.site_file import ROLES, Bridge, SiteFile, roles
from tms_config.yaml_file import located, parse
from tms_reason.errors import ConfigError

PROJECT = Path(__file__).resolve().parents[2]
CONFIGS = PROJECT / "configs"
CHOICE = "pc"  # file in the state folder: which PC this is, as chosen by `tms up --role`


@dataclass(frozen=True)
class Site:
    """A checked site: its file, the machine models it uses, and its state folder."""

    path: Path
    file: SiteFile
    models: dict[str, MachineModel]
    state: Path
    pc: str | None = None  # which of `pcs:` this one is

    @property
    def name(self) -> str:
        return self.file.name

    @property
    def domain(self) -> int:
        return self.file.domain

    @property
    def embedded_store(self) -> bool:
        return self.file.store.kind == "embedded" and not {"TMS_MONGODB_URI", "TMS_MONGODB_URI_FILE"} & set(os.environ)

    @property
    def area_folder(self) -> Path:
        """Where its areas are, beside the site file: `sites/yard/areas` for `sites/yard.yaml`."""
        return self.path.with_suffix("") / "areas"

    @property
    def area_files(self) -> list[Path]:
        """The files of its areas; none: it has no areas."""
        return sorted(self.area_folder.glob("*.geojson"))

    @property
    def bridge(self) -> Bridge:
        """Settings of the ROS-TCP endpoint; ConfigError where the site has none."""
        found = self.file.services.get("if")
        if not isinstance(found, Bridge):
            raise ConfigError(located(self.path, reasons.NoService("if", tuple(self.file.services)), "services"))
        return found

    def model_of(self, machine: str) -> MachineModel:
        """The model of a machine; ConfigError where the site has no such machine."""
        use = self.file.machines.get(machine)
        if use is None:
            raise ConfigError(located(self.path, reasons.NoMachine(machine, tuple(self.file.machines)), "machines"))
        return self.models[use.model]

    def border(self, machine: str) -> Border:
        """The border of a machine for this site's backend, with the machine's own name in its names."""
        border = self.model_of(machine).borders[self.file.names]
        own = {key: getattr(border, key).format(name=machine) for key in ("frame_prefix", "base_frame")}
        theirs = {"controller": "theirs"}
        stand_in = theirs if self.file.backend == "sim" else {}
        return border.model_copy(update={**own, **stand_in})

    def other_form(self, machine: str) -> str:
        """The form of LeafNodeBase that peers of version 6 speak on a machine's names; empty: version 5's."""
        peer = self.file.peers.get(machine)
        return "" if peer is None or peer.leaf == "v5" else peer.leaf

    def require_pc(self) -> str:
        """Which of `pcs:` this is, empty without them; ConfigError, which says how to choose, where it is not known."""
        if self.file.pcs and self.pc is None:
            raise ConfigError(reasons.WhichPc(self.name, tuple(self.file.pcs)))
        return self.pc or ""

    def start_of(self, machine: str) -> tuple[float, float, float]:
        """Start place of a stand-in: x [m], y [m], yaw [rad] in map."""
        return self.file.machines[machine].start or self.model_of(machine).start


def site_path(chosen: str | None = None) -> Path:
    """File of the chosen site: a path, a name below configs/sites/, or the demo."""
    chosen = chosen or os.environ.get("TMS_SITE") or ""
    if not chosen:
        return CONFIGS / "site.yaml"
    if chosen.endswith((".yaml", ".yml")) or "/" in chosen:
        return Path(chosen).resolve()
    return CONFIGS / "sites" / f"{chosen}.yaml"


def load_site(chosen: str | None = None) -> Site:
    """Read and check a site and every machine model it uses.

    Raises:
        ConfigError: names the file and the key.
    """
    path = site_path(chosen)
    file = parse(path, SiteFile)
    if "ROS_DOMAIN_ID" in os.environ:
        file = file.model_copy(update={"domain": _domain(os.environ["ROS_DOMAIN_ID"])})
    models: dict[str, MachineModel] = {}
    for machine, use in file.machines.items():
        if use.model not in models:
            models[use.model] = _model(path, machine, use.model, file.names)
    _check_machines(path, file, models)
    _check_pcs(path, file)
    state = Path(os.environ.get("TMS_STATE") or PROJECT / ".state" / file.name).resolve()
    return Site(path, file, models, state, _chosen_pc(path, file, state))


def _check_machines(path: Path, file: SiteFile, models: dict[str, MachineModel]) -> None:
    """Refuse two machines in one frame; and faults, peers and PCs of machines that the site does not have."""
    frames: dict[str, str] = {}
    for machine, use in file.machines.items():
        prefix = models[use.model].borders[file.names].frame_prefix.format(name=machine)
        if prefix in frames:
            raise ConfigError(located(path, reasons.SharedFrames(frames[prefix], machine, prefix), "machines", machine))
        frames[prefix] = machine
    named: list[tuple[str, tuple[str, ...]]] = [(name, ("sim", "faults", name)) for name in file.sim.faults]
    named += [(name, ("peers", name)) for name in file.peers]
    named += [(name, ("pcs", pc, "machines")) for pc, facts in file.pcs.items() for name in facts.machines]
    for machine, keys in named:
        if machine not in file.machines:
            raise ConfigError(located(path, reasons.NotUnderMachines(machine, tuple(file.machines)), *keys))


def _check_pcs(path: Path, file: SiteFile) -> None:
    """Refuse PCs without a role, and a discovery server without a PC for it."""
    for name, pc in file.pcs.items():
        if not roles(name, pc):
            raise ConfigError(located(path, reasons.NoRole(ROLES), "pcs", name))
    if file.pcs and file.network.discovery == "server" and not any("cps" in roles(*one) for one in file.pcs.items()):
        raise ConfigError(located(path, reasons.NoCps(), "network", "discovery"))


def _chosen_pc(path: Path, file: SiteFile, state: Path) -> str | None:
    """Which PC this is: TMS_PC, else what the last `tms up --role` chose here, else the only one.

    Raises:
        ConfigError: the site has no such PC.
    """
    kept = state / CHOICE
    name = os.environ.get("TMS_PC") or (kept.read_text(encoding="utf-8").strip() if kept.exists() else "")
    name = name or (next(iter(file.pcs)) if len(file.pcs) == 1 else "")
    if not file.pcs or not name:
        return None
    if name not in file.pcs:
        raise ConfigError(located(path, reasons.NoSuchPc(name, tuple(file.pcs)), "pcs"))
    return name


def _domain(text: str) -> int:
    if not text.isdigit() or int(text) > 101:
        raise ConfigError(reasons.BadVariable("ROS_DOMAIN_ID", reasons.NoDomain(text)))
    return int(text)


def _model(site: Path, machine: str, name: str, backend: Backend) -> MachineModel:
    path = CONFIGS / "machines" / f"{name}.yaml"
    if not path.exists():
        known = tuple(sorted(p.stem for p in path.parent.glob("*.yaml")))
        raise ConfigError(located(site, reasons.NoModel(name, known), "machines", machine, "model"))
    model = parse(path, MachineModel)
    if backend not in model.borders:
        raise ConfigError(located(path, reasons.NoBorder(backend, str(site)), "borders"))
    return model
