import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tapreach.bench.pattern import CODES, bar_code, pattern_jpegs, read_bar_code, with_bar_code
from tapreach.geometry.pixel import ImageSize

VGA = ImageSize(640, 480)


def decode(jpeg: bytes) -> np.ndarray:
    return cv2.imdecode(np.frombuffer(jpeg, np.uint8), cv2.IMREAD_COLOR)


def test_codes_are_all_different():
    assert len({bar_code(code) for code in range(CODES)}) == CODES


@given(st.integers(0, CODES - 1), st.integers(0, 8))
def test_one_wrong_bit_of_the_code_is_noticed(code, wrong):
    picture = with_bar_code(np.full((480, 640, 3), 90, np.uint8), code)
    columns = slice((2 + wrong) * 40, (3 + wrong) * 40)
    picture[:30, columns] = 255 - picture[:30, columns]
    assert read_bar_code(picture) is None


@pytest.mark.parametrize("width", [1280, 640, 427, 320, 160])
def test_code_is_read_after_jpeg_and_scaling(width):
    jpegs = pattern_jpegs(VGA, seed=7, count=6)
    for code, jpeg in enumerate(jpegs):
        small = cv2.resize(decode(jpeg), (width, width * 3 // 4), interpolation=cv2.INTER_AREA)
        again = decode(bytes(cv2.imencode(".jpg", small, [cv2.IMWRITE_JPEG_QUALITY, 25])[1]))
        assert read_bar_code(again) == code


def test_picture_without_code_has_none():
    assert read_bar_code(np.random.default_rng(1).integers(0, 255, (480, 640, 3), np.uint8)) is None


@pytest.mark.parametrize(("size", "wanted"), [(VGA, 44_000), (ImageSize(1280, 720), 132_000)])
def test_pictures_weigh_as_much_as_a_cameras(size, wanted):
    sizes = [len(jpeg) for jpeg in pattern_jpegs(size, seed=3, count=5)]
    assert 0.85 * wanted < min(sizes) <= max(sizes) < 1.15 * wanted


def test_same_seed_makes_the_same_pictures():
    assert pattern_jpegs(VGA, 5, 2) == pattern_jpegs(VGA, 5, 2) != pattern_jpegs(VGA, 6, 2)
