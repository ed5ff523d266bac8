"""What the decisions know of a machine, from its model, its border and the site."""

from tms_config.config import Site
from tms_config.models import DRIVE, Border, MachineModel, Source
from tms_control.holding import released_after
from tms_proof.facts import JointFacts, MachineFacts, ResponseFacts, SourceFacts, StillFacts

SETTLES = 0.6  # s from a release of `emg_stop` until joints that it has moved are seen to stand again


def facts_of(site: Site, machine: str) -> MachineFacts:
    """The facts of one machine of the site."""
    speed = site.file.sim.speed if site.file.backend == "sim" else 1.0
    return machine_facts(machine, site.model_of(machine), site.border(machine), speed)


def machine_facts(machine: str, model: MachineModel, border: Border, speed: float = 1.0) -> MachineFacts:
    """The facts of a machine; `speed`: seconds of the machine in one second, of a stand-in."""
    joints, drive, still = model.joints, model.drive, model.still
    brakes = {name: joint.velocity / joint.acceleration for name, joint in joints.items()}
    if drive is not None:
        brakes[DRIVE] = max(drive.velocity / drive.acceleration, drive.turn_velocity / drive.turn_acceleration)
    answers, ours = model.responses(border), border.controller == "ours"
    together = {name: longest_dead_time(model, border) for name in joints} if ours else {}
    responses = {
        name: ResponseFacts(together.get(name, one.dead_time), one.lag, brakes[name]) for name, one in answers.items()
    }
    drive_response = responses.pop(DRIVE, None)
    tops = {} if drive is None else {"drive_velocity": drive.velocity, "turn_velocity": drive.turn_velocity}
    return MachineFacts(
        machine, {name: JointFacts(joint.velocity, joint.min, joint.max) for name, joint in joints.items()}, responses,
        StillFacts(still.velocity, still.linear, still.angular, still.seconds),
        {name: _source(one, f"/{machine}/{getattr(border, name)}") for name, one in border.sources.items()},
        drive_response, stops_at_once=bool(border.emg_stop) and border.emg_stop_at_once, jumps=_jumps(model, border),
        speed=speed, **tops,
    )  # fmt: skip


def _source(one: Source, topic: str) -> SourceFacts:
    return SourceFacts(one.period, one.stamps, one.frozen_after, topic, one.resolution)


def longest_dead_time(model: MachineModel, border: Border) -> float:
    """The longest dead time of the joints [s]: our controller moves all of them together, as late as the latest."""
    return max((one.dead_time for joint, one in model.responses(border).items() if joint != DRIVE), default=0.0)


def _jumps(model: MachineModel, border: Border) -> float:
    """How long after a re-arm the release of `emg_stop` may move the joints of OperaSim-PhysX [s]: see Holding."""
    if border.controller == "theirs" or not border.emg_stop:
        return 0.0
    return released_after(longest_dead_time(model, border)) + SETTLES
