"""Watched targets by key, kept where the computing is done; module-level functions so that `Compute.call` can
name them.
"""

from collections import OrderedDict

from tapreach.errors import TapreachError
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.pixel import Pixel
from tapreach.robot.config import RobotDescription
from tapreach.tasks.depth_check import Checked
from tapreach.tasks.sighting import Sighting
from tapreach.tasks.target_watch import Followed, Shot, TargetWatch
from tapreach.vision.image_io import BrokenPicture, decode_gray

_MOST_WATCHES = 8
_watches: OrderedDict[int, TargetWatch] = OrderedDict()


class PictureBroken(TapreachError):
    """The frame that was tapped cannot be decoded."""


class TrackUnknown(TapreachError):
    """Nothing is followed under this key: it was closed, crowded out, or the worker was restarted."""


def open_track(
    key: int, shot: Shot, place: Pixel, description: RobotDescription, uses_background: bool = True
) -> tuple[Sighting, str]:
    """Begin to follow the place in a frame, and the background if wanted.

    Returns the first sighting, and why the place will be hard to follow, '' when it will not. Raises
    PictureBroken, and InputError for a pixel outside the picture. The oldest of more than 8 is dropped.
    """
    picture = decode_gray(shot.jpeg)
    if isinstance(picture, BrokenPicture):
        raise PictureBroken(f"the tapped picture cannot be used: {picture.reason}; tap another one")
    watch = TargetWatch(picture, shot, place, description, uses_background)
    _watches.pop(key, None)
    _watches[key] = watch
    while len(_watches) > _MOST_WATCHES:
        _watches.popitem(last=False)
    return watch.last, watch.weakness


def follow(key: int, shot: Shot, point_in_world: FloatArray | None = None, is_stop: bool = False) -> Followed:
    """Return what the next frame shows, see TargetWatch.follow; a broken frame is a loss with a reason.

    Raises TrackUnknown, and InputError for a picture of another size.
    """
    watch = _watch(key)
    picture = decode_gray(shot.jpeg)
    if isinstance(picture, BrokenPicture):
        return Followed(None, f"the picture cannot be used: {picture.reason}")
    return watch.follow(picture, shot, point_in_world, is_stop)


def check(key: int) -> Checked:
    """Return what is to be believed of what was followed so far, see TargetWatch.check.

    Raises TrackUnknown.
    """
    return _watch(key).check()


def close_track(key: int) -> None:
    """Forget it; unknown keys do no harm."""
    _watches.pop(key, None)


def _watch(key: int) -> TargetWatch:
    watch = _watches.get(key)
    if watch is None:
        raise TrackUnknown("the followed place has been forgotten: tap it again")
    return watch
