"""Pixels and picture sizes; the way from a tap in the browser to a pixel.

u grows to the right, v grows downwards, and the centre of the top-left pixel is (0, 0), as in OpenCV.
"""

from dataclasses import dataclass

from tapreach.errors import InputError
from tapreach.geometry.finite import FloatArray, finite, finite_array, positive


@dataclass(frozen=True)
class ImageSize:
    """Width and height of a picture [px]; whole numbers above zero, else InputError."""

    width: int
    height: int

    def __post_init__(self) -> None:
        for name, value in (("width", self.width), ("height", self.height)):
            if value != int(positive(f"image {name}", value)):
                raise InputError(f"image {name} is {value!r}; it must be a whole number of pixels")


@dataclass(frozen=True)
class Pixel:
    """A place in a picture [px], not rounded; finite, else InputError. It may lie outside the picture."""

    u: float
    v: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "u", finite("pixel u", self.u))
        object.__setattr__(self, "v", finite("pixel v", self.v))

    def to_array(self) -> FloatArray:
        """Return (2,) as (u, v)."""
        return finite_array("pixel", [self.u, self.v], (2,))

    def is_inside(self, size: ImageSize) -> bool:
        """Tell whether the place lies on the picture: from −0.5, the left edge, to width − 0.5."""
        return -0.5 <= self.u <= size.width - 0.5 and -0.5 <= self.v <= size.height - 0.5


def pixel_from_browser(
    x: float, y: float, left: float, top: float, shown_width: float, shown_height: float, size: ImageSize
) -> Pixel:
    """Return the pixel under a pointer at (x, y) [CSS px] over a picture shown at (left, top).

    The shown picture is `shown_width` by `shown_height` CSS pixels without its letterbox bars. Raises
    InputError for values that are not finite or a shown size that is not above zero.
    """
    across = (finite("x", x) - finite("left", left)) / positive("shown_width", shown_width)
    down = (finite("y", y) - finite("top", top)) / positive("shown_height", shown_height)
    return Pixel(across * size.width - 0.5, down * size.height - 0.5)


def require_inside(pixel: Pixel, size: ImageSize) -> Pixel:
    """Return `pixel`. Raises InputError where it lies outside a picture of `size`."""
    if not pixel.is_inside(size):
        raise InputError(
            f"pixel ({pixel.u:.1f}, {pixel.v:.1f}) lies outside the picture; u must be within -0.5 to "
            f"{size.width - 0.5} and v within -0.5 to {size.height - 0.5}"
        )
    return pixel
