"""What a day should bring."""

from pydantic import Field

from tms_config.models import Settings


class Plan(Settings):
    """`ground: {plan: ...}` of the site file."""

    bank: float = Field(gt=0, description="m3, of soil as it lies")
    loads: int | None = Field(ge=1, default=None, description="truck loads")
