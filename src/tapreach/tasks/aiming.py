"""From what was tapped or boxed to the place that is followed."""

from dataclasses import replace

from tapreach.geometry.pixel import Pixel
from tapreach.geometry.pixel_box import PixelBox
from tapreach.tasks.following import PictureBroken
from tapreach.tasks.task import Tap, TaskContext
from tapreach.vision.extent_place import place_to_follow
from tapreach.vision.image_io import BrokenPicture, decode_gray


async def aimed(context: TaskContext, tap: Tap) -> Tap:
    """Return `tap` with a place to follow: for a box one inside it with texture, for a tap the tap itself.

    Raises FrameError, and PictureBroken for a frame that cannot be decoded.
    """
    if tap.box is None:
        return tap
    frame = context.frames.get(tap.frame_id)
    box = tap.box.within(frame.size)
    place = await context.compute.call(_place_in, frame.jpeg, box)
    return replace(tap, u=place.u, v=place.v, box=box)


def _place_in(jpeg: bytes, box: PixelBox) -> Pixel:
    picture = decode_gray(jpeg)
    if isinstance(picture, BrokenPicture):
        raise PictureBroken(f"the boxed picture cannot be used: {picture.reason}; draw it on another one")
    return place_to_follow(picture, box)
