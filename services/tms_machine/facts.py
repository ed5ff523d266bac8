"""What the decisions know of a machine, from its model, its border and the site."""

from collections.abc import Mapping

from tms_config.config import Site
from tms_config.models import DRIVE, Border, MachineModel, Response, Source
from tms_proof.facts import JointFacts, MachineFacts, ResponseFacts, SourceFacts, StillFacts


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
    answers = model.responses(border)
    late = {name: _late(answers, name, border) for name in answers}
    responses = {name: ResponseFacts(late[name], one.lag, brakes[name]) for name, one in answers.items()}
    drive_response = responses.pop(DRIVE, None)
    tops = {} if drive is None else {"drive_velocity": drive.velocity, "turn_velocity": drive.turn_velocity}
    return MachineFacts(
        machine,
        {name: JointFacts(joint.velocity, joint.min, joint.max) for name, joint in joints.items()},
        responses,
        StillFacts(still.velocity, still.linear, still.angular, still.seconds),
        {name: _source(one, f"/{machine}/{getattr(border, name)}") for name, one in border.sources.items()},
        drive_response, stops_at_once=bool(border.emg_stop) and border.emg_stop_at_once, speed=speed, **tops,
    )  # fmt: skip


def _source(one: Source, topic: str) -> SourceFacts:
    return SourceFacts(one.period, one.stamps, one.frozen_after, topic, one.resolution)


def _late(answers: Mapping[str, Response], name: str, border: Border) -> float:
    """Dead time of a joint or of the tracks [s]: our controller moves all joints together, as late as the latest."""
    if border.controller == "theirs" or name == DRIVE:
        return answers[name].dead_time
    return max(one.dead_time for joint, one in answers.items() if joint != DRIVE)
