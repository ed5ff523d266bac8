"""How a run is closed that its scheduler left open: which stops end it, and what was seen of its machines."""

from collections.abc import Iterable, Mapping, Sequence

from tms_decision import STOP_PROVEN
from tms_decision import reasons as r
from tms_decision.data import Data
from tms_reason.reason import Reason

CLOCKS = 1.0  # s by which the clocks of PCs may differ
CLOSE_LIMIT = STOP_PROVEN + 10.0  # s for the receipts: a gateway that starts, too, waits for its run before it latches


class LostRun(Data):
    """What its checkpoint tells."""

    run_id: str
    number: int  # fencing number
    machines: Sequence[str]
    last_time: float  # s since 1970, of the last line
    sent_at: Mapping[str, float]  # machine -> s since 1970 of its last goal


class Stop(Data):
    """The receipt of a stop, as the scheduler received it."""

    machine: str
    run: int  # fencing number of the run that it ended
    at: float  # s since 1970, when it began
    confirmed: bool
    latched: bool
    what: Reason  # for the history


def stops_of(lost: LostRun, receipts: Iterable[Stop]) -> list[Stop]:
    """The receipts of the stops at the end of this run, in order; one may have come twice."""
    seen = {(one.at, one.machine): one for one in receipts if one.run == lost.number}
    begin = {name: max(lost.last_time - CLOCKS, lost.sent_at.get(name, 0.0)) for name in lost.machines}
    return [one for (at, name), one in sorted(seen.items()) if name in begin and at > begin[name]]


def all_told(lost: LostRun, stops: Iterable[Stop]) -> bool:
    """Whether the last stop of each machine is known."""
    return set(lost.machines) <= {one.machine for one in stops if one.latched}


def what_was_seen(lost: LostRun, stops: Sequence[Stop]) -> tuple[Reason, list[Reason]]:
    """Why the run is interrupted, with each machine's last receipt or the lack of one; and the alarms to raise.

    Only a stop that has latched is the end of a motion: after another one, a goal that waited for it may have left.
    """
    last = {one.machine: one for one in stops if one.latched}
    stood = tuple(name for name in lost.machines if name in last and last[name].confirmed)
    unseen = tuple(name for name in lost.machines if name not in stood)
    seen: list[Reason] = [r.SchedulerWasLost()]
    seen += [r.SeenToStand(stood)] if stood else []
    seen += [r.NotSeenStanding(unseen)] if unseen else []
    none = r.NoReceipt(CLOSE_LIMIT)
    alarms = [last[name].what if name in last else r.MachineUnconfirmed(name, none) for name in unseen]
    return r.RunInterrupted(tuple(seen), lost.run_id), alarms
