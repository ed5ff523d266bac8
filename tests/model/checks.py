"""Which sites are explored, and which defects are planted."""

from model.spin import Check

#                          machines gateways runs tries goals faults presses arms cancels long sketched
ONE = Check("1x2", "one machine, two runs, a press, at most two faults", (1, 1, 2, 2, 1, 2, 1, 0, 0, 1, 1))
ENDS = Check("1x2-ends", "... one fault: every history ends, and its stops", (1, 1, 2, 2, 1, 1, 1, 1, 0, 1, 1), True)
CANCEL = Check("1x2-cancel", "... which an operator cancels, one fault", (1, 1, 2, 2, 1, 1, 0, 0, 1, 1, 1))
TWIN = Check("1x1-twin", "one machine with a second gateway, a press, one fault", (1, 2, 1, 1, 1, 1, 1, 0, 0, 0, 1))
TWO = Check("2x2", "two machines, two runs, one fault", (2, 2, 2, 1, 1, 1, 0, 0, 0, 0, 2))
FIRST = Check("2x2-first", "... the first with two faults, the last sketched", (2, 2, 2, 2, 1, 2, 0, 0, 0, 1, 1))
LAST = Check("2x2-last", "... the last with two faults, the first sketched", (2, 2, 2, 2, 1, 2, 0, 0, 0, 1, 0))
SMALL = Check("1x2-small", "one machine, two runs, one fault", (1, 1, 2, 2, 1, 1, 1, 1, 0, 1, 1))
CHECKS = (ONE, TWIN, ENDS, CANCEL, TWO, FIRST, LAST)  # the largest first: two are explored at once

DEFECTS = {
    "LATCH_NOT_WRITTEN": ("a stop is told before its latch is on the disk", SMALL),
    "REARM_WITHOUT_PROOF": ("a re-arm does not wait for the proof of stand-still", SMALL),
    "REARM_NOT_VOID": ("a press does not make a re-arm void that waits for the disk", SMALL),
    "FENCE_NOT_CHECKED": ("the number of the run in a goal is not compared with the permit", SMALL),
    "SENT_WHILE_HOST_STANDS_IN": ("a goal leaves while the host agent commands the machine", SMALL),
    "SENT_BEFORE_NOTE": ("a goal leaves before the disk says whose it is", SMALL),
    "PRESS_NOT_HANDED_ON": ("a press that a killed gateway had heard is not handed on", SMALL),
    "PRESS_FORGOTTEN_EARLY": ("the host agent forgets a press that the gateway shows, before the disk has it", SMALL),
    "PROOF_IN_DEAD_TIME": ("a stop is proven in the dead time of the machine", SMALL),
    "GOAL_MAY_BE_OPEN": ("a stop is proven while its goal is still on its way", SMALL),
    "LOSS_NOT_SEEN": ("a process behind a moving goal is lost, and nothing happens", SMALL),
    "START_WITHOUT_STOP": ("a gateway that starts does not stop a machine that was left moving", ONE),
    "NOT_SEEN_NOT_LATCHED": ("a stop that is not proven does not latch", SMALL),
    "NO_TIME_OUT": ("a stop that is never proven never ends", SMALL),
    "STOP_NOT_ASKED_AGAIN": ("a run does not ask the next gateway for the stop that the last one forgot", SMALL),
    "NO_NOTE_MEANS_ARMED": ("a second gateway without a note counts its machine as armed", TWIN),
}
