"""What the tables of a robot file are made of."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

Positive = Annotated[float, Field(gt=0, allow_inf_nan=False)]
Finite = Annotated[float, Field(allow_inf_nan=False)]
RangeDeg = tuple[Finite, Finite]
RangeM = tuple[Finite, Finite]
Vector3 = tuple[Finite, Finite, Finite]


class Section(BaseModel):
    """A table of a file that people write: unknown keys are errors."""

    model_config = ConfigDict(extra="forbid", frozen=True)
