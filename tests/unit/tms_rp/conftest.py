"""The real machine file: planning is tested with the numbers that a site uses."""

import pytest

from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_rp.kinds.backhoe.planner import Backhoe


@pytest.fixture(scope="session")
def model() -> MachineModel:
    return parse(CONFIGS / "machines" / "zx200.yaml", MachineModel)


@pytest.fixture(scope="session")
def backhoe(model: MachineModel) -> Backhoe:
    return Backhoe(model)
