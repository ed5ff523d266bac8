"""Why the scheduler refuses a run, what happens in one, how its goals and machines end, and what preflight finds."""

from tms_reason.quantities import Seconds
from tms_reason.reason import Reason
from tms_reason.remedies import ADD_RECORD, CANCEL, CORRECT_RECORD, LOGS, RUNS, STATUS, TASKS, Remedy

ADD_SHARED = Remedy("records", "tms param set /{record} --create FIELD=VALUE", "Add the record")


# fmt: off
# states of a run, as the history tells them
class StatePreparing(Reason, text="preparing"): pass
class StateRunning(Reason, text="running"): pass
class StateStopping(Reason, text="stopping"): pass
class StateSuccess(Reason, text="success"): pass
class StateFailure(Reason, text="failure"): pass
class StateCancelled(Reason, text="cancelled"): pass
class StateStopUnconfirmed(Reason, text="stop_unconfirmed"): pass
class StateInterrupted(Reason, text="interrupted"): pass
class StateRefused(Reason, text="refused"): pass
class StateAbandoned(Reason, text="abandoned"): pass
class StateBecause(Reason, text="{state}: {why}"): state: Reason; why: Reason

# why a run ends, or is refused
class SchedulerStopped(Reason, text="the scheduler was stopped"): pass
class Resumed(Reason, text="resumed"): pass
class GivenUp(Reason, text="given up by an operator after an interruption"): pass
class NodeFailed(Reason, text="{node}: {why}", details="node {path}"): node: str; why: Reason; path: str
class NoRun(Reason, text="no run '{run}' is active (active: {active})", action=RUNS): run: str; active: tuple[str, ...]
class NotInterrupted(Reason, text="no run '{run}' is interrupted (interrupted: {runs})", code="NO_INTERRUPTED_RUN",
    action=RUNS): run: str; runs: tuple[str, ...]
class NoQuestion(Reason, text="the question '{question}' is closed: it was answered, timed out or its run has ended"):
    question: str
class Preflight(Reason, text="{why}"): why: Reason
class PreflightMore(Preflight, text="{why} (and {more} more)", action=TASKS): more: int
class MachineBusy(Reason, text="{machine} is in run {run}", action=CANCEL): machine: str; run: str
class CannotStart(Reason, text="{process} cannot be started: {why}", action=LOGS): process: str; why: Reason
class NoDisk(Reason, text="this PC's disk does not take what must be kept of a run ({why}): free some space"):
    why: Reason
class DiskSlow(Reason, text="it is too slow"): pass

# events of a run
class TreeOf(Reason, text="{nodes} nodes"): nodes: int
class NodeChanged(Reason, text="{node}: {old} -> {new}"): node: str; old: str; new: str
class NodeChangedBecause(Reason, text="{node}: {old} -> {new}: {why}"): node: str; old: str; new: str; why: Reason
class LeftOut(Reason, text="{count} further changes are left out: a loop goes round"): count: int
class AnsweredYes(Reason, text="yes, by {person}"): person: str
class AnsweredNo(Reason, text="no, by {person}"): person: str
class NotAnswered(Reason, text="none: the question was withdrawn or timed out"): pass

# goals of leaves
class ProcessState(Reason, text="process {process} is {state}", action=LOGS): process: str; state: str
class MachineNotReady(Reason, text="{machine} is not ready: {why}"): machine: str; why: Reason

# stops
class MachineStood(Reason, text="{machine} {stood}"): machine: str; stood: Reason
class MachineStoodBy(Reason, text="{machine} {stood} ({evidence})"): machine: str; stood: Reason; evidence: Reason

# the history
class HistoryInMemory(Reason, text="the history is kept in memory only: {why}"): why: Reason
class HistoryLost(Reason, text="the history of run {run} has lost {count} entries, events {first} to {last}"):
    run: str; count: int; first: int; last: int
class EntryTooLarge(Reason, text="an entry of {size} bytes, allowed are {most}"): size: int; most: int
class JournalFull(Reason, text="{size} bytes wait already for the database", action=STATUS): size: int
class DiskFull(Reason, text="too much waits for the disk"): pass

# preflight
class KnownAtRun(Reason, text="machine or subtask is known only when the leaf starts"): pass
class BadSubtaskName(Reason,
    text="'{name}' can be no ROS name: at most 200 letters, digits and _, no blanks"): name: str
class ServedElsewhere(Reason, text="'{subtask}' of {machine} is served by another system: its record is not checked"):
    subtask: str; machine: str
class NotOffered(Reason, text="{machine} offers no '{subtask}' (there: {subtasks})"):
    machine: str; subtask: str; subtasks: tuple[str, ...]
class NoRecord(Reason, text="no record {record}", action=ADD_RECORD): record: str
class NoRecordNear(Reason, text="no record {record}; {near}", action=ADD_RECORD): record: str; near: Reason
class RecordUnfit(Reason, text="record {record} does not fit {subtask}: {why}", action=CORRECT_RECORD):
    record: str; subtask: str; why: Reason
class MotionRefused(Reason, text="{subtask} with record {record}: the planner would refuse it: {why}"):
    record: str; subtask: str; why: Reason
class MotionRefusedNow(Reason,
    text="{subtask} with record {record}: as the site is now, the planner would refuse it: {why}"):
    record: str; subtask: str; why: Reason
class MotionsUnplanned(Reason, text="motions of the arm that were not planned beforehand: {count}"): count: int
class JointUnfit(Reason, text="{joint}: {why}"): joint: str; why: Reason
class RecordOld(Reason,
    text="record {record} is {age} old, allowed are {limit}: the leaf fails unless sensing writes it"):
    record: str; age: Seconds; limit: Seconds
class RecordAgeUnknown(Reason,
    text="record {record} is of unknown age, allowed are {limit}: the leaf fails unless sensing writes it"):
    record: str; limit: Seconds
class InputSilent(Reason, text="sensing input {name} should write record {record} and is silent"):
    name: str; record: str
class NoSharedRecord(Reason, text="no shared record {record}", action=ADD_SHARED):
    record: str
class NoSharedField(Reason, text="shared record {record} has no field '{field}'"): record: str; field: str
class SharedStatic(Reason, text="shared record {record} is static: a run must not write it"): record: str
class NobodyWrites(Reason, text="no active task and no sensing input writes {field} of {record}, which is waited for"):
    field: str; record: str
class NoRecordField(Reason, text="record {record} has no field '{field}'"): record: str; field: str
