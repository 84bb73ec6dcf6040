"""Things that stand in a scene and can be tapped, pushed and (some) gripped."""

from math import prod
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, model_validator

CLAW_OPENING = 0.074
LIFT_MASS = 0.25

Length = Annotated[float, Field(gt=0.0, le=10.0, allow_inf_nan=False)]
Place = Annotated[float, Field(ge=-50.0, le=50.0, allow_inf_nan=False)]
Angle = Annotated[float, Field(ge=-360.0, le=360.0, allow_inf_nan=False)]


class Entry(BaseModel):
    """A table of a scene file: unknown keys are errors."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class SceneObject(Entry):
    """What all objects share. Position on the floor, world frame: x ahead of the robot's start, y left."""

    name: str = Field("", description="shown in benches; kind and number when left out")
    position: tuple[Place, Place]
    up: Annotated[float, Field(ge=0.0, le=2.5, allow_inf_nan=False)] = 0.0
    yaw_deg: Angle = 0.0
    mass: Annotated[float, Field(gt=0.0, le=50.0, allow_inf_nan=False)] | None = None
    graspable: bool = True

    @property
    def outer_size(self) -> tuple[float, float, float]:
        """Size of the box that holds it, along its own axes [m]."""
        raise NotImplementedError

    @property
    def width(self) -> float:
        """The narrowest width across which the claw could close [m]."""
        return min(self.outer_size[:2])

    @property
    def tall(self) -> float:
        """Height from its foot to its top [m]."""
        return self.outer_size[2]

    @property
    def weight(self) -> float:
        """Mass [kg]; light packaging of 150 kg/m³ of its box (at least 15 g) unless given."""
        return self.mass if self.mass is not None else max(0.015, 150.0 * prod(self.outer_size))

    @model_validator(mode="after")
    def _can_be_gripped(self) -> "SceneObject":
        if self.graspable and self.width > CLAW_OPENING - 0.004:
            raise ValueError(
                f"is {self.width * 1000:.0f} mm wide, the claw opens to {CLAW_OPENING * 1000:.0f} mm and "
                "needs 4 mm to spare: make it smaller or set graspable = false"
            )
        if self.graspable and self.weight > LIFT_MASS:
            raise ValueError(
                f"weighs {self.weight:.2f} kg, the arm lifts {LIFT_MASS} kg: give a smaller mass "
                "or set graspable = false"
            )
        return self


class Box(SceneObject):
    """A packet, parcel or crate; size along its own x, y, z."""

    kind: Literal["box"]
    size: tuple[Length, Length, Length]
    label: Literal["tea", "mint", "oats", "crate", "cardboard"] = "tea"

    @property
    def outer_size(self) -> tuple[float, float, float]:
        """See SceneObject."""
        return self.size


class RoundObject(SceneObject):
    """A body of revolution about the vertical."""

    radius: Length
    height: Length

    @property
    def outer_size(self) -> tuple[float, float, float]:
        """See SceneObject."""
        return (2.0 * self.radius, 2.0 * self.radius, self.height)


class Can(RoundObject):
    """A drink or food can."""

    kind: Literal["can"]
    radius: Length = 0.033
    height: Length = 0.115
    label: Literal["cola", "beans", "soup"] = "cola"


class Bottle(RoundObject):
    """A bottle with a cap."""

    kind: Literal["bottle"]
    radius: Length = 0.033
    height: Length = 0.21
    label: Literal["juice", "water", "sauce"] = "juice"


class Cup(RoundObject):
    """A mug without a handle, open above."""

    kind: Literal["cup"]
    radius: Length = 0.034
    height: Length = 0.085
    label: Literal["blue", "red"] = "blue"


class Ball(SceneObject):
    """A ball; it rolls."""

    kind: Literal["ball"]
    radius: Length = 0.032
    label: Literal["beach", "football"] = "football"

    @property
    def outer_size(self) -> tuple[float, float, float]:
        """See SceneObject."""
        return (2.0 * self.radius, 2.0 * self.radius, 2.0 * self.radius)


AnyObject = Annotated[Box | Can | Bottle | Cup | Ball, Field(discriminator="kind")]
