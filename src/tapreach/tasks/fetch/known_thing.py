"""What is known of the thing between one look and the next: where it was, how large, and how it looked."""

import math
from dataclasses import dataclass, replace

import numpy as np

from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel import Pixel
from tapreach.geometry.planar_motion import PlanarPose
from tapreach.tasks.fetch.thing import ThingSize
from tapreach.tasks.known_place import KnownPlace
from tapreach.vision.own_colours import OwnColours

PUSHED_SD, PUSHED_UP_SD = 0.03, 0.01
"""How far the claw may have pushed the thing that it tried to grip, or let it fall, one sigma [m]."""
MISTAKEN_SD = 0.08
"""How wrong the distance may have been of what the claw closed on in vain, one sigma [m]."""
_USUAL_HALF = 0.03
"""Half of how large a thing is that was never measured [m]."""


@dataclass(frozen=True)
class Appearance:
    """How the tapped place looked: the picture, the pixel in it, and its distance then [m]."""

    jpeg: bytes
    pixel: Pixel
    distance: float


@dataclass(frozen=True, eq=False)
class KnownThing:
    """place: of the tapped spot. size: None where it was never measured; its middle is told by `axis_offset`
    (3,) [m] from the tapped spot. appearance: None where no picture of it is left. colours: its own, None
    where they could not be told. was_missed: the claw was sent there in vain.
    """

    place: KnownPlace
    size: ThingSize | None = None
    axis_offset: FloatArray | None = None
    appearance: Appearance | None = None
    colours: OwnColours | None = None
    was_missed: bool = False

    @property
    def middle(self) -> FloatArray:
        """The thing's middle (3,) [m]; the tapped spot where that is not known."""
        return self.place.point_in_world + (0.0 if self.axis_offset is None else self.axis_offset)

    @property
    def half_size(self) -> FloatArray:
        """Half its width and half its height (2,) [m], usual ones where it was never measured."""
        if self.size is None:
            return np.full(2, _USUAL_HALF)
        return np.array([self.size.width, self.size.height]) / 2.0

    def pushed(self) -> "KnownThing":
        """Return it after the claw was around it, or tried to be: it may stand, or lie, elsewhere."""
        size = None if self.size is None else replace(self.size, seen=())
        place = self.place.perhaps_moved(PUSHED_SD, PUSHED_UP_SD)
        return replace(self, place=place, size=size, was_missed=True)

    def place_seen_from(self, here: PlanarPose) -> KnownPlace:
        """Return its place for a new look from a base at `here`: where the claw has missed it, its distance
        was perhaps wrong all the time.
        """
        off = self.place.point_in_world[:2] - [here.x, here.y]
        along = math.atan2(off[1], off[0])
        return self.place.perhaps_along(along, MISTAKEN_SD) if self.was_missed else self.place
