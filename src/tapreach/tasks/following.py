"""Trackers by key, kept where the computing is done; module-level functions so that `Compute.call` can
name them.
"""

from collections import OrderedDict
from collections.abc import Sequence

from tapreach.errors import TapreachError
from tapreach.vision.image_io import BrokenPicture, decode_gray
from tapreach.vision.track import Guess, Track, TrackStatus
from tapreach.vision.tracker import PatchTracker

_MOST_TRACKERS = 8
_trackers: OrderedDict[int, PatchTracker] = OrderedDict()


class PictureBroken(TapreachError):
    """The frame that was tapped cannot be decoded."""


class TrackUnknown(TapreachError):
    """Nothing is followed under this key: it was closed, crowded out, or the worker was restarted."""


def open_track(key: int, jpeg: bytes, u: float, v: float) -> str:
    """Begin to follow the place at (u, v) of a frame; return why that will be hard, '' when it will not.

    Raises PictureBroken, and InputError for a pixel outside the picture. The oldest of more than 8 is
    dropped.
    """
    picture = decode_gray(jpeg)
    if isinstance(picture, BrokenPicture):
        raise PictureBroken(f"the tapped picture cannot be used: {picture.reason}; tap another one")
    tracker = PatchTracker(picture, u, v)
    _trackers.pop(key, None)
    _trackers[key] = tracker
    while len(_trackers) > _MOST_TRACKERS:
        _trackers.popitem(last=False)
    return tracker.weakness


def follow(key: int, jpeg: bytes, guesses: Sequence[Guess] = ()) -> Track:
    """Return where the place is in the next frame; a broken frame is a loss with a reason.

    Raises TrackUnknown, and InputError for a picture of another size.
    """
    tracker = _trackers.get(key)
    if tracker is None:
        raise TrackUnknown("the followed place has been forgotten: tap it again")
    picture = decode_gray(jpeg)
    if isinstance(picture, BrokenPicture):
        reason = f"the picture cannot be used: {picture.reason}"
        return Track(TrackStatus.LOST, reason, None, 0.0, 1.0, 0.0)
    return tracker.follow(picture, guesses)


def close_track(key: int) -> None:
    """Forget it; unknown keys do no harm."""
    _trackers.pop(key, None)
