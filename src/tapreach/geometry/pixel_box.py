"""A box drawn on a picture."""

from dataclasses import dataclass

from tapreach.errors import InputError
from tapreach.geometry.finite import finite
from tapreach.geometry.pixel import ImageSize, Pixel

LEAST_SIDE_PX = 4.0
"""A smaller box says no more than a tap."""


@dataclass(frozen=True)
class PixelBox:
    """An upright box [px], pixel centres counted as in `Pixel`: left < right, top < bottom.

    Raises InputError for values that are not finite, and for sides of less than 4 px.
    """

    left: float
    top: float
    right: float
    bottom: float

    def __post_init__(self) -> None:
        for name in ("left", "top", "right", "bottom"):
            object.__setattr__(self, name, finite(f"box {name}", getattr(self, name)))
        if min(self.width, self.height) < LEAST_SIDE_PX:
            raise InputError(
                f"the box is {self.width:.1f} px wide and {self.height:.1f} px high; it must be at least "
                f"{LEAST_SIDE_PX:.0f} px each way, given as left, top, right, bottom"
            )

    @property
    def width(self) -> float:
        """Right minus left [px]."""
        return self.right - self.left

    @property
    def height(self) -> float:
        """Bottom minus top [px]."""
        return self.bottom - self.top

    @property
    def middle(self) -> Pixel:
        """The centre."""
        return Pixel((self.left + self.right) / 2.0, (self.top + self.bottom) / 2.0)

    @property
    def foot(self) -> Pixel:
        """The middle of the lower edge: where a thing stands."""
        return Pixel((self.left + self.right) / 2.0, self.bottom)

    def within(self, size: ImageSize) -> "PixelBox":
        """Return the part on a picture of `size`. Raises InputError where less than 4 px of it are."""
        return PixelBox(
            max(self.left, -0.5),
            max(self.top, -0.5),
            min(self.right, size.width - 0.5),
            min(self.bottom, size.height - 0.5),
        )

    def holds(self, pixel: Pixel) -> bool:
        """Tell whether a pixel lies in it, edges included."""
        return self.left <= pixel.u <= self.right and self.top <= pixel.v <= self.bottom

    def inner(self, share: float) -> "PixelBox":
        """Return the box with the same middle and `share` of its sides."""
        across, down = share * self.width / 2.0, share * self.height / 2.0
        middle = self.middle
        return PixelBox(middle.u - across, middle.v - down, middle.u + across, middle.v + down)
