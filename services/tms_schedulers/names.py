"""The schedulers of a site: `tms:ts`, and one more on each PC with the role `scheduler`, for its machines."""

from collections.abc import Iterable
from dataclasses import dataclass

from tms_config.config import Site
from tms_config.site_file import roles

MAIN = "tms:ts"
ID = len("20260131-060000-1a2b")  # of a run's id


@dataclass(frozen=True)
class Scheduler:
    """One of them."""

    process: str  # as supervisord names it
    machines: frozenset[str]  # a task of these only is its own
    prefix: str = "/tms"

    @property
    def suffix(self) -> str:
        """The end of the ids of its runs, so that each scheduler knows its own."""
        return self.process.removeprefix(MAIN).replace("_", "-", 1)

    def owns(self, run_id: str) -> bool:
        """Whether it has begun this run."""
        return run_id[ID:] == self.suffix

    def named(self, name: str) -> str:
        """The ROS name of one of its actions, services or topics."""
        return f"{self.prefix}/{name}"


def schedulers(site: Site) -> tuple[Scheduler, ...]:
    """The main one first; its machines are those that nobody else has."""
    others, rest = list[Scheduler](), set(site.file.machines)
    for pc, facts in site.file.pcs.items():
        if "scheduler" in roles(pc, facts):
            others.append(Scheduler(f"{MAIN}_{pc}", frozenset(facts.machines), f"/tms/ts_{pc.replace('-', '_')}"))
            rest -= set(facts.machines)
    return Scheduler(MAIN, frozenset(rest)), *others


def own(site: Site, process: str) -> Scheduler:
    """The scheduler that a process is; `process` is one."""
    return next(one for one in schedulers(site) if one.process == process)


def responsible(site: Site, machines: Iterable[str]) -> Scheduler:
    """Whose task it is: of the one that has all the machines, else of the main one."""
    wanted = set(machines)
    return next((one for one in schedulers(site) if wanted and wanted <= one.machines), schedulers(site)[0])
