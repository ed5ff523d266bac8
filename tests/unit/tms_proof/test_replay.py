"""Found by the simulation: a quick machine that replays two seconds of its record was believed between two leaps."""

from simulation.plant import DEAD_TIME, PERIOD, Fault, Plant, facts
from tms_proof.standstill import JOINTS, StandStill

LOOP = 2.0  # s of the record


def test_a_record_that_leaps_every_two_seconds_is_never_believed() -> None:
    plant, watch, now = Plant(), StandStill(facts()), 100.0

    def tell(seconds: float) -> bool:
        nonlocal now
        proven = False
        for _ in range(round(seconds / PERIOD)):
            now += PERIOD
            sample = plant.tell(now)
            assert sample is not None
            watch.take(JOINTS, sample)
            proven = proven or (proof is not None and watch.proven(proof, now))
        return proven

    proof = None
    plant.accept(1, 0.5, 0.3, now)  # the record: a short motion, then stand-still
    tell(LOOP)
    plant.fault = Fault(coast=2.5, replay=True)
    plant.goal = None
    plant.accept(2, 20.0, 0.3, now)
    tell(DEAD_TIME + 0.5)
    proof = watch.proof(now, strongest=False)
    plant.halt(now)
    assert plant.moves() and not tell(8.0)
