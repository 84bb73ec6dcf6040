"""What all messages of the control socket are made of."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

Finite = Annotated[float, Field(allow_inf_nan=False)]
FrameId = Annotated[int, Field(ge=1)]


class Message(BaseModel):
    """Base of all messages: unknown keys are errors."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class Request(Message):
    """From the page. `seq` rises by one with every message of a session."""

    seq: int = Field(ge=1)


class Timed(Request):
    """A request that moves something: it is dropped when it is too old, or the picture its sender saw is."""

    client_ms: Finite = Field(description="the page's performance.now() when the person acted [ms]")
    frame_id: FrameId | None = Field(description="the frame on the screen; null when there was none")
