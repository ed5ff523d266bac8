"""The tree asks for leaf goals, things happen to them, and it is decided. A machine gets one goal at a time."""

from tms_decision import reasons as r
from tms_decision.leaf import effects as f
from tms_decision.leaf import events as e
from tms_decision.leaf.state import GoalState, LeafGoal, LeafGoals
from tms_decision.owner import LEAVES, Owner
from tms_reason.reason import Reason

SERVER_LIMIT = 10.0  # s for a subtask's server to be there
DATABASE_LIMIT = 15.0  # s that a leaf waits for a database that is away
ASK_AGAIN = 0.5  # s until a goal is sent again, also after a failure: a loop around a leaf must not flood the history


def ask(goals: LeafGoals, asked: e.GoalAsked, now: float) -> tuple[LeafGoal, list[f.Effect]]:
    """Begin a goal; it is sent at once if the machine is free and the server is there."""
    goal = LeafGoal(asked, now)
    if (before := goals.replay.take(goal.key)) is not None:
        goal.state, goal.reason = (GoalState.SUCCEEDED, None) if before else (GoalState.FAILED, r.FailedBefore())
        goals.note(goal, r.NotRepeatedDone(goal.name) if before else r.NotRepeatedFailed(goal.name))
    else:
        goals.open.append(goal)
        if goal.key in goals.failed:
            goal.not_before, goal.reason = goals.failed[goal.key] + ASK_AGAIN, r.SentAgainSoon()
        _try(goals, goal, asked.seen, now)
    return goal, goals.taken()


def step(goals: LeafGoals, event: e.Event, now: float) -> list[f.Effect]:
    """Let something happen; returns what is to be done, in this order."""
    match event:
        case e.CancelAsked(number):
            for goal in [goal for goal in goals.open if goal.asked.number == number]:
                _cancel(goals, goal)
        case e.Looked(seen):
            for goal in [goal for goal in goals.open if goal.asked.number in seen]:
                _look(goals, goal, seen[goal.asked.number], now)
        case e.Accepted(call):
            _accepted(goals, _of(goals, call))
        case e.Ended(call):
            _ended(goals, _of(goals, call), event, now)
        case e.MachineStopped(machine):
            goals.stopping.remove(machine)
    return goals.taken()


def _of(goals: LeafGoals, call: int) -> LeafGoal | None:
    """The goal of a sending; None if that was given up for lost."""
    return next((goal for goal in goals.open if goal.call == call), None)


def _cancel(goals: LeafGoals, goal: LeafGoal) -> None:
    goal.cancelled = True
    if goal.call:
        goals.do(f.Cancel(goal.call))
    else:  # it is not at a server, so it moves no machine
        goal.state = GoalState.CANCELLED
        goals.open.remove(goal)


def _look(goals: LeafGoals, goal: LeafGoal, seen: e.Seen, now: float) -> None:
    if goal.pid is None and seen.pid is not None:  # nobody knew it when the goal was sent: is it still the same one?
        goal.pid = seen.pid if seen.age > now - goal.begun else 0
    if not goal.call:
        _try(goals, goal, seen, now)
    elif (why := _loss(goal, seen, now)) is not None:
        unanswered = goal.unanswered(now)
        if unanswered:
            goals.do(f.Cancel(goal.call))  # in case it is accepted after all
        goals.do(f.Lose(goal.call, dead=_replaced(goal, seen)))
        _lost(goals, goal, why, now, counts=not (unanswered and goal.recovers(now)))


# sending


def _try(goals: LeafGoals, goal: LeafGoal, seen: e.Seen, now: float) -> None:
    if now < goal.not_before:
        return
    goal.begun = now if goal.machine in goals.stopping else goal.begun  # a stop ends by itself, after 13 s at most
    goal.reason = _obstacle(goals, goal, seen)
    if goal.reason is None:
        _send(goals, goal, seen, now)
    elif (gone := _gone_for_good(goals, goal, seen)) is not None:
        _end(goals, goal, GoalState.FAILED, gone, now)
    elif now - goal.begun > SERVER_LIMIT:
        _end(goals, goal, GoalState.FAILED, r.ForTooLong(goal.reason, SERVER_LIMIT), now)


def _send(goals: LeafGoals, goal: LeafGoal, seen: e.Seen, now: float) -> None:
    goals.calls += 1
    goal.call, goal.pid, goal.begun = goals.calls, seen.pid, now
    owner = Owner(goals.run, (goals.calls - 1) % LEAVES + 1)
    goals.note(goal, r.GoalSent(goal.name, goal.key[3]))
    goals.do(f.KeepSent(goal.key), f.Send(goal.key, goal.call, owner))


def _obstacle(goals: LeafGoals, goal: LeafGoal, seen: e.Seen) -> Reason | None:
    """Why the goal cannot be sent now."""
    if goal.machine in goals.stopping:
        return r.MachineStopping(goal.machine)
    if any(other.cancelled and other.call and other.machine == goal.machine for other in goals.open):
        return r.LastGoalOpen(goal.machine)
    if seen.below is not None and goal.losses:
        return seen.below
    if seen.process is not None:
        return seen.process
    return seen.machine if seen.ready else r.ProcessAway(goal.name)


def _gone_for_good(goals: LeafGoals, goal: LeafGoal, seen: e.Seen) -> Reason | None:
    """Why waiting cannot help: supervisord has given up a process, or only a person can re-arm the machine."""
    if seen.latch is not None:
        return r.MachineLatched(goal.machine, seen.latch)
    if (fatal := seen.given_up) is not None and fatal not in goals.given_up:
        goals.given_up.add(fatal)
        goals.note(goal, fatal, "alarm")
    return fatal


# answers


def _accepted(goals: LeafGoals, goal: LeafGoal | None) -> None:
    if goal is not None and goal.state is GoalState.SENDING:
        goal.state = GoalState.RUNNING
        goals.note(goal, r.GoalAccepted(goal.name))


def _ended(goals: LeafGoals, goal: LeafGoal | None, event: e.Ended, now: float) -> None:
    if goal is None:
        return
    if event.outcome == "SUCCEEDED":
        _end(goals, goal, GoalState.SUCCEEDED, None, now)
    elif event.outcome == "CANCELED":
        _end(goals, goal, GoalState.CANCELLED, r.GoalCancelled(goal.name), now)
    elif _may_ask_again(goal, event.failure, now):
        goal.reason, goal.state = event.why, GoalState.SENDING
        goal.call, goal.begun, goal.not_before = 0, now, now + ASK_AGAIN
        goals.note(goal, event.why, "again")
    elif e.Failure.LOST in event.failure:
        _lost(goals, goal, r.GoalLost(goal.name, event.why), now)
    elif event.outcome == "REJECTED":
        _end(goals, goal, GoalState.FAILED, r.GoalRefused(goal.name, event.why), now)
    else:
        _end(goals, goal, GoalState.FAILED, r.GoalGaveUp(goal.name, event.why), now)


def _may_ask_again(goal: LeafGoal, failure: e.Failure, now: float) -> bool:
    """Whether to send again soon: the database may come back; after a loss, processes may still discover each other."""
    if goal.cancelled:
        return False
    if e.Failure.NO_STORE in failure:
        goal.waits_since = now if goal.waits_since is None else goal.waits_since
        if now - goal.waits_since < DATABASE_LIMIT:
            return True
    return e.Failure.UNREACHED in failure and goal.recovers(now)


def _end(goals: LeafGoals, goal: LeafGoal, state: GoalState, reason: Reason | None, now: float) -> None:
    if state is not GoalState.SUCCEEDED and not goal.cancelled:
        goals.failed[goal.key] = now
    if state is not GoalState.CANCELLED and not goal.cancelled:
        goals.do(*(f.KeepGone(key, left) for key, left in goals.replay.moved_on(goal.key[0])))
        goals.do(f.KeepDone(goal.key, state is GoalState.SUCCEEDED))
    goal.call, goal.reason = 0, reason
    goal.state = state  # last: the tree may see it now and ask for the next goal
    goals.open.remove(goal)
    goals.note(goal, reason or r.GoalSucceeded(goal.name))


# losses


def _loss(goal: LeafGoal, seen: e.Seen, now: float) -> Reason | None:
    """Why a goal never ends by itself."""
    if goal.unanswered(now):
        return goal.asked.no_answer
    if _replaced(goal, seen):
        return r.ProcessEnded(goal.name)
    return None if seen.ready else goal.asked.away


def _replaced(goal: LeafGoal, seen: e.Seen) -> bool:
    """Whether the subtask is another process now than when the goal was sent."""
    return goal.pid is not None and seen.pid is not None and seen.pid != goal.pid


def _lost(goals: LeafGoals, goal: LeafGoal, why: Reason, now: float, *, counts: bool = True) -> None:
    """Handle the loss of a process during a goal: have the machine stopped, then send the goal again, a few times.

    `counts`: a server that does not answer soon after a loss has not discovered us yet, which is no further loss.
    """
    if counts:
        goal.losses += 1
        goal.lost_at = now
    goals.stopping.append(goal.machine)
    goals.do(f.StopMachine(goal.machine, why))
    if goal.cancelled:
        _end(goals, goal, GoalState.CANCELLED, why, now)
    elif goal.losses > goals.retries:
        _end(goals, goal, GoalState.FAILED, r.LostTimes(why, goal.losses), now)
    else:
        goal.call, goal.state, goal.begun = 0, GoalState.SENDING, now
        goal.not_before = now + ASK_AGAIN * goal.losses
        goal.reason = r.SentAgain(why)
        goals.note(goal, r.SentAgainTimes(why, goal.losses, goals.retries), "loss")
