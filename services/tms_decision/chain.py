"""Whether all processes behind a goal are alive: scheduler, subtask, planner. Pure logic."""

from collections.abc import Mapping

from tms_decision.data import Data
from tms_decision.owner import Owner
from tms_decision.reasons import HeldByAnother, NoPlanner, NoScheduler, NoSubtask, OldRun
from tms_reason.reason import Reason

SCHEDULER = "ts"


class Gap(Data):
    """Why a goal has no permit; `late` when waiting cannot help."""

    reason: Reason
    late: bool = False


def gap(owner: Owner | None, held: Mapping[str, Owner]) -> Gap | None:
    """What is missing behind a goal; `held` is what each living process stands behind.

    A goal of a foreign client (owner None) needs no process behind it, but is refused while a run holds the machine.
    """
    run = held.get(SCHEDULER)
    if owner is None:
        return None if run is None else Gap(HeldByAnother(), late=True)
    if run is None:
        return Gap(NoScheduler())
    if run.run != owner.run:
        return Gap(OldRun(owner.run, run.run), late=owner.run < run.run)
    for hop in range(owner.hop):
        if Owner(owner.run, owner.leaf, hop) not in held.values():
            return Gap(NoPlanner() if hop else NoSubtask())
    return None


def members(owner: Owner | None, held: Mapping[str, Owner]) -> dict[str, Owner]:
    """The processes that a goal depends on, with what each of them holds."""
    if owner is None:
        return {}
    chain = {Owner(owner.run, owner.leaf, hop) for hop in range(owner.hop)}
    return {name: what for name, what in held.items() if what in chain or name == SCHEDULER}
