import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tapreach.bench.video_client import Arrival, Viewing, parse_frame
from tapreach.errors import InputError
from tapreach.geometry.pixel import ImageSize
from tapreach.robot.clock import MS
from tapreach.server.frame_packet import Encoded


@given(st.integers(1, 2**32 - 1), st.binary(max_size=50), st.binary(min_size=1, max_size=100))
def test_viewer_reads_what_the_server_packs(frame_id, meta, jpeg):
    message = Encoded(frame_id, 7 * MS, ImageSize(640, 480), meta, jpeg).message(9 * MS)
    arrival = parse_frame(message, 12 * MS)
    assert arrival == Arrival(frame_id, 7 * MS, 12 * MS, 640, len(jpeg))
    assert arrival.age_ms == 5


@pytest.mark.parametrize("message", [b"", b"TRV1", b"XXXX" + bytes(40), struct.pack("<4s", b"TRV2")])
def test_other_messages_are_named(message):
    with pytest.raises(InputError, match="not a video message"):
        parse_frame(message, 0)


def test_rate_counts_intervals():
    viewing = Viewing([Arrival(n, 0, n * 50 * MS, 640, 1) for n in range(1, 22)])
    assert viewing.rate_hz == 20
    assert Viewing().rate_hz == 0
    assert len(viewing.since(500 * MS).arrivals) == 12
