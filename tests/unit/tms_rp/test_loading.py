"""Every excavator loads every truck, wherever around it the truck stands."""

import math

import pytest

from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_control.links import placed
from tms_rp.clearance import Clearance
from tms_rp.kind import Moves
from tms_rp.kinds import load
from tms_rp.kinds.backhoe.digging import excavate
from tms_rp.kinds.backhoe.goals import Dig, TipGoal
from tms_rp.kinds.backhoe.linkage import ArmAngles, Tip
from tms_rp.kinds.backhoe.planner import Backhoe
from tms_rp.neighbour import Neighbour, Posture
from tms_rp.scene import Scene
from tms_rp.ways import Ways

MODELS = {
    name: parse(CONFIGS / "machines" / f"{name}.yaml", MachineModel)
    for name in ("zx200", "zx120", "ic120", "mst110cr", "mst2200")
}
AWAY = 6.5  # m from the excavator to the middle of the bed
ABOVE = 0.8  # m from the bed's edge to the bucket's tip
ANGLE = 1.0  # rad, of the bucket over the bed: it is closed
BESIDE = math.tau / 3  # rad, from the truck to the place where it digs: no truck stands there
PLACES = 6


def bed(truck: MachineModel) -> tuple[float, float]:
    """The middle of a truck's bed [m, along it] and its edge [m, up], lowered, in base_link."""
    link = next(link for link in truck.shapes if link.startswith(("vessel", "dump")))
    origin = next(one for one in truck.geometry.values() if one.child == link)
    parent = next((one.xyz[2] for one in truck.geometry.values() if one.child == origin.parent), 0.0)
    shape = truck.shapes[link]
    return origin.xyz[0] + (shape.min[0] + shape.max[0]) / 2, parent + origin.xyz[2] + shape.max[2]


def curled(backhoe: Backhoe, start: ArmAngles, at: TipGoal) -> ArmAngles:
    """The bucket in the soil, curled in."""
    reach = ArmAngles(*excavate(backhoe, start, Dig(at, depth=1.0, drag=0.0, lift=0.0)).targets[1])
    return reach._replace(arm=reach.arm + 0.1, bucket=1.7)


@pytest.mark.parametrize("truck", ["ic120", "mst110cr", "mst2200"])
@pytest.mark.parametrize("excavator", ["zx200", "zx120"])
def test_from_six_places(excavator: str, truck: str) -> None:
    model, other = MODELS[excavator], MODELS[truck]
    backhoe, ways, clearance = Backhoe(model), Ways(model, load("backhoe")), Clearance(model)
    middle, edge = bed(other)
    start = ArmAngles(*(model.initial.get(name, -0.5) for name in load("backhoe").joints))
    for place in range(PLACES):
        bearing = math.tau * place / PLACES
        across = bearing + math.pi / 2
        x, y = AWAY * math.cos(bearing), AWAY * math.sin(bearing)
        stands = placed(x - middle * math.cos(across), y - middle * math.sin(across), across)
        scene = Scene(
            tuple(Neighbour(truck, other).obstacles(stands, 0.0, Posture(dict.fromkeys(other.joints, 0.0), 0.0)))
        )
        dig = TipGoal(5 * math.cos(bearing + BESIDE), 5 * math.sin(bearing + BESIDE), 0.5, 1.2)
        dug = curled(backhoe, start, dig)
        over = backhoe.reach(Tip(x, y, edge + ABOVE, ANGLE))
        near = over._replace(swing=dug.swing + math.remainder(over.swing - dug.swing, math.tau))
        plan = ways.plan(dug, Moves((near,)), scene)
        clearance.check(plan.made, scene)
