"""Real processes tell the same history of a plan as the simulation: `make replay`."""

import pytest

from replay.acts import Plan
from replay.history import history
from replay.plans import PLANS
from replay.real import Real
from replay.real_site import RealSite
from replay.simulated import histories

pytestmark = [pytest.mark.system, pytest.mark.timeout(300)]
SEEDS = range(12)


@pytest.mark.turns
@pytest.mark.parametrize("plan", PLANS, ids=lambda plan: plan.name)
def test_real_processes_tell_a_history_of_the_simulation(
    plan: Plan, real_site: RealSite, capsys: pytest.CaptureFixture[str]
) -> None:
    expected = histories(plan, SEEDS)
    told = history(Real(plan, real_site).run())
    with capsys.disabled():
        print(f"\n{plan.name}:\n{told}")
    assert told in expected, "\nor\n".join(map(str, expected))
