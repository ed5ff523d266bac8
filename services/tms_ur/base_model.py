"""The base of the API's models."""

from pydantic import BaseModel, ConfigDict


class Model(BaseModel):
    """Base of all answers; what a client sends is checked as strictly as configuration."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=True)
