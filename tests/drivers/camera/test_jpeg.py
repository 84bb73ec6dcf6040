"""Where a JPEG ends and how large it is, whatever its bytes are cut into."""

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.drivers.camera.pictures import jpeg

from tapreach.drivers.camera.jpeg import BrokenJpeg, JpegWalk, whole_jpeg
from tapreach.geometry.pixel import ImageSize

# A thumbnail inside of an Exif segment has an end mark of its own.
EXIF = (
    b"\xff\xe1"
    + (2 + 6 + 700).to_bytes(2, "big")
    + b"Exif\0\0"
    + (jpeg(9, 16, 16)[:698] + b"\xff\xd9").ljust(700)
)


def variants() -> dict[str, bytes]:
    picture = cv2.imdecode(np.frombuffer(jpeg(1), np.uint8), cv2.IMREAD_COLOR)
    progressive = cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_PROGRESSIVE, 1])[1].tobytes()
    restarts = cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_RST_INTERVAL, 4])[1].tobytes()
    plain = jpeg(1)
    return {
        "plain": plain,
        "progressive": progressive,
        "restarts": restarts,
        "thumbnail": plain[:2] + EXIF + plain[2:],
    }


VARIANTS = variants()


@pytest.mark.parametrize("kind", VARIANTS)
def test_whole_jpeg_keeps_its_bytes_and_tells_its_size(kind):
    data = VARIANTS[kind]
    assert whole_jpeg(data) == (data, ImageSize(160, 120))


def test_padding_of_a_camera_is_cut_off():
    assert whole_jpeg(VARIANTS["plain"] + bytes(513))[0] == VARIANTS["plain"]


@pytest.mark.parametrize("kind", VARIANTS)
def test_no_beginning_of_a_jpeg_is_whole(kind):
    data = VARIANTS[kind]
    for length in range(len(data)):
        with pytest.raises(BrokenJpeg):
            whole_jpeg(data[:length])


@given(kind=st.sampled_from(sorted(VARIANTS)), cuts=st.lists(st.integers(0, 5000), max_size=12))
def test_end_is_found_with_the_last_byte_however_the_bytes_are_cut(kind, cuts):
    data, walk = VARIANTS[kind], JpegWalk()
    ends = [min(cut, len(data) - 1) for cut in sorted(cuts)]
    assert [walk.advance(data[:end]) for end in ends] == [None] * len(ends)
    assert walk.advance(data + b"\r\n--frame") == len(data)


@given(st.binary(max_size=400), st.integers(0, 700))
def test_no_bytes_do_more_than_to_be_called_broken(noise, at):
    plain = VARIANTS["plain"]
    for data in (noise, b"\xff\xd8" + noise, plain[:at] + noise + plain[at + len(noise) :]):
        try:
            found, size = whole_jpeg(data)
        except BrokenJpeg:
            continue
        assert data.startswith(found)
        assert size.width > 0
