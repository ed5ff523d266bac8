"""Who has sent a goal: whether a foreign sender is understood, and whether the sender can still cancel the goal."""

from tms_config.config import Site
from tms_decision.owner import parse
from tms_decision.reasons import ProcessEnded
from tms_machine.leaf_forms import misfit
from tms_machine.permit import RemotePermit
from tms_machine.reasons import BorderLost
from tms_reason.reason import Reason
from tms_ros.client import AnyPeer
from tms_ros.server import AnyGoal
from tms_runtime.app import App

GONE = 2.0  # s without the scheduler's permit until a goal that waits ends: on a full PC, it lapses for a moment


class Senders:
    """The senders of one subtask's goals.

    With peers of version 6, foreign goals come through `<machine>:if`, which alone can bring a cancel: with it the
    goal ends. Else the peer's own form is checked. rclpy does not tell which client has sent a goal, so a client that
    would be misunderstood refuses the goals of all foreign ones.

    A scheduler that is lost takes its permits along, so that every motion of its goals ends. A subtask that only waits
    would go on, and be busy when the run is resumed: its goal ends with the scheduler's permit.
    """

    def __init__(self, app: App, *, waits: bool) -> None:
        """`waits`: the subtask may wait for long while nothing moves."""
        self._app, self._waits, self._subtask = app, waits, str(app.process.action)
        self._site: Site = app.site
        self._permits: dict[str, RemotePermit] = {}  # made with the first goal that needs it: each wakes the process
        self._goal: AnyGoal | None = None
        self._stood = False  # the scheduler was seen to stand behind the run of this goal
        self._ends = False  # this goal was cancelled here
        self._peers: list[AnyPeer] = []  # of the scheduler

    def refusal(self, goal: AnyGoal) -> Reason | None:
        """Why a goal is not begun; None for every goal of a run."""
        if parse(goal.uuid) is not None or self._site.other_form(self._app.machine):
            return None
        return misfit(self._app.ros, self._site, self._app.machine, self._subtask, servers=False)

    def watch(self, goal: AnyGoal | None) -> None:
        """Cancel this goal when its sender is lost; None: there is no goal any more."""
        self._goal, self._stood, self._ends = goal, False, False
        if goal is None:
            return
        if parse(goal.uuid) is not None:
            if self._waits:
                self._see("ts")
        elif self._site.other_form(self._app.machine):
            self._see(f"if_{self._subtask}")

    @property
    def gone(self) -> bool:
        """Whether no scheduler stands behind the run of the present goal any more, so that it ends soon."""
        goal, permit = self._goal, self._permits.get("ts")
        owner = None if goal is None else parse(goal.uuid)
        if owner is None or permit is None or not self._stood:
            return self._ends
        return self._behind(permit) != owner.run

    def add(self, peer: AnyPeer) -> None:
        """Let the open calls of a peer that the scheduler serves end with it."""
        if peer not in self._peers:
            self._peers.append(peer)

    def _see(self, process: str) -> None:
        if process in self._permits:
            self._changed(self._permits[process])
        else:
            app = self._app
            self._permits[process] = RemotePermit(app.ros, app.pulse, app.machine, process, self._changed)

    def _changed(self, permit: RemotePermit) -> None:
        goal = self._goal
        if goal is None:
            return
        if (owner := parse(goal.uuid)) is None:
            if permit.lost(goal.uuid):
                self._end(goal, BorderLost(f"{self._app.machine}:if"))
            return
        behind = self._behind(permit)
        if behind == owner.run:
            self._stood = True
            for peer in self._peers:
                peer.mark_alive()
        elif self._stood and behind is not None:  # a run after this one
            self._lose(goal)
        elif self._stood:
            self._app.ros.after(GONE, lambda: self._judge(permit, goal, owner.run))

    @staticmethod
    def _behind(permit: RemotePermit) -> int | None:
        """The run that a scheduler stands behind."""
        owner = parse(permit.goal) if permit.alive else None
        return None if owner is None else owner.run

    def _judge(self, permit: RemotePermit, goal: AnyGoal, run: int) -> None:
        if self._goal is goal and self._behind(permit) != run:
            self._lose(goal)

    def _lose(self, goal: AnyGoal) -> None:
        for peer in self._peers:
            peer.mark_lost()
        self._end(goal, ProcessEnded("tms:ts"))

    def _end(self, goal: AnyGoal, why: Reason) -> None:
        self._goal, self._ends = None, True
        self._app.log.warning("cancelled", goal=goal.id, reason=why)
        goal.cancel()
