"""A picture of a robot that nodded is laid over the one before, whatever else moved in it."""

import cv2
import numpy as np

from tapreach.vision.claw_motion import change_between
from tapreach.vision.image_io import Color
from tapreach.vision.steadied import steadied
from vision.synthetic import texture, view


def room() -> Color:
    grey = np.clip(view(texture(9))[0], 0, 255).astype(np.uint8)
    return np.repeat(grey[:, :, None], 3, axis=2)


def nodded(picture: Color) -> Color:
    turn = cv2.getRotationMatrix2D((320, 240), 0.4, 1.0)
    turn[:, 2] += (3.0, -4.0)
    return np.asarray(cv2.warpAffine(picture, turn, (640, 480), borderMode=cv2.BORDER_REPLICATE), np.uint8)


def test_what_stands_still_lies_where_it_did_and_what_moved_has_changed() -> None:
    before = room()
    after = nodded(before)
    after[200:420, 300:460] = 20
    plain = change_between(before, after)[20:-20, 20:-20]
    steady = change_between(before, steadied(after, before))
    still = np.ones(steady.shape, dtype=bool)
    still[190:430, 290:470] = False
    assert np.mean(steady[20:-20, 20:-20][still[20:-20, 20:-20]]) < 0.35 * np.mean(plain)
    assert np.median(steady[230:390, 330:430]) > 20.0


def test_picture_without_corners_is_left_as_it_is() -> None:
    plain = np.full((480, 640, 3), 90, np.uint8)
    assert steadied(room(), plain) is not None
    assert np.array_equal(steadied(plain, plain), plain)
