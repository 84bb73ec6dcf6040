"""Pictures come whole out of a stream, wherever its bytes are cut and whatever lies between them."""

import itertools

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.drivers.camera.pictures import jpeg, part

from tapreach.drivers.camera.multipart import MOST_HEADER_BYTES, MultipartParser

JPEGS = [jpeg(seed) for seed in range(3)]


def jpegs_of(stream: bytes, cuts: list[int], boundary: str = "frame") -> tuple[list[bytes], int]:
    parser, found = MultipartParser(boundary), []
    edges = [0, *sorted(min(cut, len(stream)) for cut in cuts), len(stream)]
    for begin, end in itertools.pairwise(edges):
        found += [part.jpeg for part in parser.feed(stream[begin:end])]
    return found, parser.skipped


@given(
    with_length=st.booleans(),
    cuts=st.lists(st.integers(0, 3 * len(part(JPEGS[0]))), max_size=20),
    preamble=st.sampled_from([b"", b"\r\n", b"hello\r\n"]),
)
def test_parts_are_found_wherever_the_bytes_are_cut(with_length, cuts, preamble):
    stream = preamble + b"".join(part(data, with_length=with_length) for data in JPEGS)
    assert jpegs_of(stream, cuts) == (JPEGS, 0)


def test_parts_are_found_when_bytes_come_one_by_one():
    stream = b"".join(part(data) for data in JPEGS)
    assert jpegs_of(stream, list(range(len(stream)))) == (JPEGS, 0)


def test_picture_is_there_with_its_last_byte_though_no_length_was_told():
    head_and_jpeg = part(JPEGS[0], with_length=False).removesuffix(b"\r\n")
    parser = MultipartParser("frame")
    assert parser.feed(head_and_jpeg[:-1]) == []
    assert [part.jpeg for part in parser.feed(head_and_jpeg[-1:])] == [JPEGS[0]]


@pytest.mark.parametrize("told", ["--frame", "frame", "-frame"])
def test_dashes_in_the_parameter_do_not_matter(told):
    assert jpegs_of(part(JPEGS[0]), [], told) == ([JPEGS[0]], 0)


@pytest.mark.parametrize("length", [0, 10, 1 << 40])
def test_wrong_content_length_does_not_matter(length):
    head = f"--frame\r\nContent-Length: {length}\r\n\r\n".encode()
    assert jpegs_of(head + JPEGS[0] + b"\r\n" + part(JPEGS[1]), []) == (JPEGS[:2], 0)


@given(length=st.integers(0, len(JPEGS[0]) - 1), cuts=st.lists(st.integers(0, 20000), max_size=8))
def test_jpeg_that_is_cut_short_is_counted_and_the_next_one_comes(length, cuts):
    # The picture after a cut one may be taken for its rest; the second after it is always whole.
    stream = part(JPEGS[0][:length]) + b"".join(part(data) for data in JPEGS)
    found, skipped = jpegs_of(stream, cuts)
    assert skipped >= 1
    assert found[-2:] == JPEGS[1:]
    assert set(found) <= set(JPEGS)


def test_part_that_is_no_picture_is_counted_and_skipped():
    text = b"--frame\r\nContent-Type: text/plain\r\n\r\nhello\r\n"
    assert jpegs_of(text + part(JPEGS[0]) + text + part(JPEGS[1]), []) == (JPEGS[:2], 2)


def test_headers_without_end_are_given_up():
    endless = b"--frame\r\n" + b"X-Long: " + b"a" * (2 * MOST_HEADER_BYTES)
    found, skipped = jpegs_of(endless + b"\r\n" + part(JPEGS[0]), [MOST_HEADER_BYTES + 100])
    assert (found, skipped) == ([JPEGS[0]], 1)


def test_headers_may_end_by_line_feeds_alone_and_names_are_small():
    stream = b"--frame\nContent-type: image/jpeg\nX-Timestamp: 12.5\n\n" + JPEGS[0]
    (found,) = MultipartParser("frame").feed(stream)
    assert found.headers == {"content-type": "image/jpeg", "x-timestamp": "12.5"}


@given(st.binary(max_size=3000))
def test_no_bytes_do_more_than_to_be_skipped(noise):
    found, _ = jpegs_of(noise + b"--frame\r\n\r\n" + noise + b"\r\n" + part(JPEGS[0]), [])
    assert found in ([JPEGS[0]], [])
