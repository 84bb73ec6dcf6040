"""Pictures made ready for cutting a thing out: decoded, without the lens's distortion, dark parts raised."""

import cv2
import numpy as np

from tapreach.geometry.camera import Camera
from tapreach.vision.image_io import BrokenPicture, Color, decode_color

_ROOTS = np.round(255.0 * np.sqrt(np.arange(256) / 255.0)).astype(np.uint8)


def picture_of_view(jpeg: bytes, lens: Camera) -> Color:
    """Return a JPEG's picture as a pinhole of the lens's matrix would show it, in roots of brightness: noise
    and edges count the same in the dark. Black where it is broken or of another size.
    """
    picture = decode_color(jpeg)
    height, width = lens.size.height, lens.size.width
    if isinstance(picture, BrokenPicture) or picture.shape[:2] != (height, width):
        return np.zeros((height, width, 3), np.uint8)
    straight = picture
    if any(lens.distortion):
        straight = np.asarray(cv2.undistort(picture, lens.matrix(), np.array(lens.distortion)), np.uint8)
    return np.asarray(cv2.LUT(straight, _ROOTS), np.uint8)
