"""What is known of the thing between one look and the next: where it was, how large, and how it looked."""

from dataclasses import dataclass, replace

from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel import Pixel
from tapreach.tasks.fetch.thing import ThingSize
from tapreach.tasks.known_place import KnownPlace

PUSHED_SD, PUSHED_UP_SD = 0.03, 0.01
"""How far the claw may have pushed the thing that it tried to grip, or let it fall, one sigma [m]."""


@dataclass(frozen=True)
class Appearance:
    """How the tapped place looked: the picture, the pixel in it, and its distance then [m]."""

    jpeg: bytes
    pixel: Pixel
    distance: float


@dataclass(frozen=True, eq=False)
class KnownThing:
    """place: of the tapped spot. size: None where it was never measured; its middle is told by `axis_offset`
    (3,) [m] from the tapped spot. appearance: None where no picture of it is left.
    """

    place: KnownPlace
    size: ThingSize | None = None
    axis_offset: FloatArray | None = None
    appearance: Appearance | None = None

    def pushed(self) -> "KnownThing":
        """Return it after the claw was around it, or tried to be: it may stand, or lie, elsewhere."""
        return replace(self, place=self.place.perhaps_moved(PUSHED_SD, PUSHED_UP_SD))
