"""Who presses the machine's own stop: the host agent in place of this gateway, or an unknown publisher.

A press of the host agent, made while this gateway was frozen or away, is released once the machine was seen to stand.
A press of any other publisher latches, since only a person's re-arm may release it.
"""

from tms_decision.gateway import stops
from tms_decision.gateway.arming import PRESSED
from tms_decision.gateway.events import Signal, StandsIn
from tms_decision.gateway.state import Doubt, Gateway
from tms_decision.gateway.stops import StopKind
from tms_decision.reasons import PressedByOthers, SoftwareStop

DOUBT = 0.3  # s for the host agent's message to come, if it has pressed
YOUNG = 10.0  # s in which a new gateway finds the host agent's two publishers one by one, on a busy PC
YOUNG_DOUBT = 1.5  # s
STANDBY = 3.0  # s; a host agent that commands the machine repeats every 0.5 s that it does


def pressed(gateway: Gateway, now: float) -> None:
    """The emergency stop is pressed; of a latched machine, this gateway presses it itself."""
    if gateway.latch.cause is None:
        doubt = YOUNG_DOUBT if now - gateway.recovery.begun < YOUNG else DOUBT
        gateway.doubts.append(Doubt(now - doubt, now + doubt))


def stood_in(gateway: Gateway, now: float) -> None:
    """The host agent says that it has pressed."""
    gateway.stood_in_at, gateway.stood_in = now, True


def stands_in(gateway: Gateway, now: float, event: StandsIn) -> None:
    """The host agent says whether it commands the machine: its cancels would end a goal that leaves now."""
    gateway.standby = now + STANDBY if event.on else now


def advance(gateway: Gateway, now: float) -> None:
    """Judge presses after their time of doubt."""
    for doubt in [doubt for doubt in gateway.doubts if now >= doubt.until]:
        gateway.doubts.remove(doubt)
        if gateway.stood_in_at < doubt.since and gateway.latch.cause is None:
            stops.stop(gateway, now, PressedByOthers(), StopKind.LATCH)


def signal(gateway: Gateway, now: float, event: Signal) -> None:
    """Receive /emergency_signal: true stops and latches, however often it is repeated; false does not re-arm."""
    fresh = now - gateway.pressed > PRESSED
    gateway.pressed = now if event.on else float("-inf")
    if event.on and (fresh or gateway.latch.cause is None):
        stops.stop(gateway, now, SoftwareStop(), StopKind.LATCH)
