import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tapreach.drivers.sim.protocol import (
    AskTruth,
    Drive,
    Failed,
    FrameParser,
    MoveArm,
    Ready,
    Telemetry,
    decode,
    encode,
    encode_frame,
)
from tapreach.errors import DriverError

numbers = st.floats(allow_nan=False)


@given(numbers, numbers)
def test_drive_survives_the_way(linear: float, angular: float) -> None:
    assert decode(encode(Drive(linear, angular))) == Drive(linear, angular)


@pytest.mark.parametrize(
    "message",
    [
        MoveArm(0.1, -0.2, 0.3, 0.04),
        AskTruth(2**62),
        Ready("egl"),
        Failed("SetupError", 'no "OpenGL" — é\n'),
        Telemetry(5, -3, 2**31, *[0.5] * 8, True, False),
    ],
)
def test_message_survives_the_way(message: MoveArm | AskTruth | Ready | Failed | Telemetry) -> None:
    assert decode(encode(message)) == message


def test_nan_arrives_as_nan_for_the_board_to_refuse() -> None:
    message = decode(encode(Drive(math.nan, 0.0)))
    assert isinstance(message, Drive)
    assert math.isnan(message.linear)


@given(st.binary(max_size=80))
def test_junk_is_refused_by_name(packet: bytes) -> None:
    with pytest.raises(DriverError):
        decode(packet)


@pytest.mark.parametrize("packet", [b'["Drive", 1.0]', b'["Dance"]', b"[]", b"{}", b"3", b"[[]]"])
def test_wrong_shape_is_refused(packet: bytes) -> None:
    with pytest.raises(DriverError):
        decode(packet)


@given(
    st.lists(st.tuples(st.integers(0, 2**62), st.binary(max_size=300)), max_size=5),
    st.lists(st.integers(1, 400), min_size=1),
)
def test_pictures_come_out_whole_however_the_stream_is_split(
    pictures: list[tuple[int, bytes]], cuts: list[int]
) -> None:
    stream = b"".join(encode_frame(at, at, jpeg) for at, jpeg in pictures)
    parser, got, place = FrameParser(), [], 0
    while place < len(stream):
        size = cuts[place % len(cuts)]
        got += parser.feed(stream[place : place + size])
        place += size
    assert got == pictures


def test_broken_picture_stream_is_an_error() -> None:
    with pytest.raises(DriverError, match="broken"):
        FrameParser().feed(b"x" * 64)
