"""Broken pictures are results with a reason, and never half a picture."""

import cv2
import numpy as np
import pytest

from tapreach.vision.image_io import BrokenPicture, decode_color, decode_gray
from vision.synthetic import texture, view


def jpeg() -> bytes:
    picture = np.clip(view(texture(1))[0], 0, 255).astype(np.uint8)
    return bytes(cv2.imencode(".jpg", picture)[1])


def test_whole_jpeg_decodes_to_its_size() -> None:
    picture = decode_gray(jpeg())
    assert isinstance(picture, np.ndarray)
    assert (picture.shape, picture.dtype) == ((480, 640), np.uint8)


def test_color_picture_keeps_the_order_of_its_colors() -> None:
    blue = np.zeros((48, 64, 3), np.uint8)
    blue[:, :, 0] = 200
    picture = decode_color(bytes(cv2.imencode(".jpg", blue)[1]))
    assert isinstance(picture, np.ndarray)
    assert np.abs(picture.reshape(-1, 3).mean(axis=0) - (200, 0, 0)).max() < 4.0


@pytest.mark.parametrize(
    ("broken", "word"),
    [
        (b"", "begin"),
        (b"not a picture", "begin"),
        (jpeg()[: len(jpeg()) // 2], "cut short"),
        (b"\xff\xd8\xff\xd9", "decoded"),
    ],
)
def test_broken_jpeg_says_why(broken: bytes, word: str) -> None:
    for result in (decode_gray(broken), decode_color(broken)):
        assert isinstance(result, BrokenPicture)
        assert word in result.reason
