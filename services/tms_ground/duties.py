"""Which run holds each machine, and whether it moves or is stopped: told by the scheduler and the gateways."""

from collections.abc import Iterable

from tms_msg_rc.msg import MachineState
from tms_msg_ts.msg import RunStates

from tms_config.config import Site
from tms_ground.work import Duty
from tms_ros.node import Ros
from tms_schedulers.hearing import hear_runs


class Duties:
    """The last that was told; the executor thread writes, other threads read."""

    def __init__(self, ros: Ros, site: Site, machines: Iterable[str]) -> None:
        self._runs: dict[str, str] = {}  # machine -> run; replaced, never changed
        self._states: dict[str, MachineState] = {}
        hear_runs(ros, site, self._on_runs)
        for machine in machines:
            ros.subscribe(MachineState, f"/{machine}/rc/state", self._on_state, latched=True)

    def of(self, machine: str) -> Duty:
        """What a machine does for whom."""
        state = self._states.get(machine)
        if state is None:
            return Duty(self._runs.get(machine, ""))
        return Duty(self._runs.get(machine, ""), state.moving, bool(state.latch or state.hold))

    def _on_runs(self, message: RunStates) -> None:
        self._runs = {machine: run.run_id for run in message.runs for machine in run.machines}

    def _on_state(self, message: MachineState) -> None:
        self._states[message.machine] = message
