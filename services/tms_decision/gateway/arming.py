"""What a person does at a stopped machine: re-arm it, take it to drive it by hand, give it back."""

from tms_decision import STOP_PROVEN
from tms_decision import reasons as r
from tms_decision.gateway import notes, stops
from tms_decision.gateway.effects import Emergency, Publish, Rearmed, Taken
from tms_decision.gateway.events import Manual, NoteKept, RearmAsked, TakeAsked
from tms_decision.gateway.state import Gateway, Rearm
from tms_decision.gateway.stops import StopKind
from tms_reason.reason import Foreign, Reason

PROOF_LIMIT = 3.0  # s that a person waits for a stop that is still being proven
PRESSED = 1.0  # s that a software stop counts as pressed after its last message


def ask(gateway: Gateway, now: float, asked: RearmAsked) -> None:
    """Take a step of a re-arm: one without a token returns cause and token, one with it arms."""
    gateway.rearms.append(Rearm(asked, now + PROOF_LIMIT))
    advance(gateway, now)


def advance(gateway: Gateway, now: float) -> None:
    """Answer re-arms that have waited for a stop to be proven."""
    for one in list(gateway.rearms):
        if not one.note and (not stops.busy(gateway) or now >= one.until):
            _rearm(gateway, now, one)


def _rearm(gateway: Gateway, now: float, one: Rearm) -> None:
    latch, token = gateway.latch, one.asked.token
    cause = latch.cause or latch.hold
    wrong = r.NotStopped(gateway.facts.name) if cause is None else _keeps_from_arming(gateway, now)
    if wrong is None and token:
        refused = latch.confirm(token, now)
        wrong = None if refused is None else r.BadToken(refused)
    if wrong is not None or not token:
        given = "" if wrong is not None else one.asked.fresh
        if given:
            latch.request(given, now)
        _answer(gateway, one, cause, wrong, given)
        return
    one.closings = latch.closings
    one.note = notes.hold(gateway, "", 0, armed=True)
    if not one.note:
        _arm(gateway, now, one)


def _arm(gateway: Gateway, now: float, one: Rearm) -> None:
    """Arm the machine: the note on the disk says so by now, and the last stop is older than the token."""
    cause = gateway.latch.cause or gateway.latch.hold
    gateway.latch.open()
    gateway.watch.accept_clocks()
    gateway.stood_in = gateway.recovery.open = False
    gateway.vigil.end(now, gateway.facts.jumps)
    gateway.do(Emergency(False), Publish())
    gateway.log("armed", warning=False)
    _answer(gateway, one, cause, None, "")


def noted(gateway: Gateway, now: float, event: NoteKept) -> None:
    """A note is on the disk, or is not: of a state, or of who drives."""
    for one in list(gateway.rearms):
        if one.note and event.number >= one.note:
            if event.problem is not None and event.number == one.note:
                _answer(gateway, one, gateway.latch.cause or gateway.latch.hold, r.NotKept(event.problem), "")
            elif one.closings != gateway.latch.closings:  # stopped again meanwhile
                _answer(gateway, one, gateway.latch.cause, r.BadToken(r.TokenUnknown()), "")
                notes.keep(gateway)
            else:
                _arm(gateway, now, one)
    if event.number in gateway.takes:
        _taken(gateway, now, event.problem, *gateway.takes.pop(event.number))


def _answer(gateway: Gateway, one: Rearm, cause: Reason | None, wrong: Reason | None, token: str) -> None:
    gateway.rearms.remove(one)
    armed = gateway.latch.cause is None and gateway.latch.hold is None
    gateway.do(Rearmed(one.asked.request, cause, token, armed, wrong))


def _keeps_from_arming(gateway: Gateway, now: float) -> Reason | None:
    machine, watch = gateway.facts.name, gateway.watch
    if gateway.active is not None:
        return r.StillActive(machine)
    if gateway.by_hand is not None:
        return r.DrivenByHand(gateway.by_hand, machine)
    if now - gateway.pressed < PRESSED:
        return r.CausePersists(r.StillPressed())
    silent, trouble = gateway.silent(now), watch.trouble(now)
    if silent is not None:
        return r.CausePersists(r.NotSeen(machine, silent))
    if trouble is not None and not trouble.passes:
        return r.CausePersists(r.NotBelieved(machine, trouble.reason))
    if stops.busy(gateway):
        return r.CausePersists(r.StillProven(machine))
    if not watch.standing(now, passing=True):
        return r.CausePersists(r.NotStill(machine))
    return None


def take(gateway: Gateway, now: float, asked: TakeAsked) -> None:
    """Let a person drive the machine, or end that; the gateway still watches it, but no command opposes the person."""
    wrong = _keeps_from_giving(gateway) if asked.back else _keeps_from_taking(gateway, now, asked.who)
    if wrong is not None:
        gateway.do(Taken(asked.request, wrong))
        return
    gateway.takes[notes.drive(gateway, "" if asked.back else asked.who)] = asked, now


def _taken(gateway: Gateway, now: float, problem: Reason | None, asked: TakeAsked, since: float) -> None:
    wrong: Reason | None = r.NotKept(problem) if problem is not None else None
    if wrong is None and not asked.back and (wrong := _keeps_from_taking(gateway, now, asked.who)) is not None:
        notes.drive(gateway, "")  # a goal has begun meanwhile
    if wrong is not None:
        gateway.do(Taken(asked.request, wrong))
    elif asked.back:
        gateway.by_hand = None
        made = stops.stop(gateway, now, r.GivenBack(asked.who), StopKind.PLAIN)
        made.requests.append(asked.request)
        made.limit = max(since + STOP_PROVEN, now + gateway.watch.settles)  # the person has waited for the disk, too
    else:
        gateway.by_hand = Foreign(asked.who)
        gateway.log("taken", who=asked.who)
        gateway.do(Taken(asked.request), Publish())


def _keeps_from_taking(gateway: Gateway, now: float, who: str) -> Reason | None:
    machine = gateway.facts.name
    if not who.strip() or not who.isprintable():
        return r.Nameless()
    if gateway.by_hand is not None:
        return r.DrivenByHand(gateway.by_hand, machine)
    if gateway.active is not None:
        return r.StillActive(machine)
    if gateway.run is not None:
        return r.HeldByRun(gateway.holder(now), machine)
    return None


def _keeps_from_giving(gateway: Gateway) -> Reason | None:
    driver = gateway.by_hand
    return r.NotTaken(gateway.facts.name) if driver is None or isinstance(driver, r.ManualMode) else None


def manual(gateway: Gateway, now: float, event: Manual) -> None:
    """The machine's own signal that a person drives it by its levers."""
    if event.on and gateway.by_hand is None:
        stops.stop(gateway, now, r.ManualOn(), StopKind.PLAIN)
        gateway.by_hand = r.ManualMode()
    elif not event.on and isinstance(gateway.by_hand, r.ManualMode):
        gateway.by_hand = None
        stops.stop(gateway, now, r.ManualOff(), StopKind.PLAIN)
    gateway.do(Publish())
