"""Whatever comes in, out comes a message or a refusal that names the problem."""

import json

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tapreach.server.messages import Ack, Drive
from tapreach.server.parsing import LONGEST_TEXT, parsed

DRIVE = {"type": "drive", "seq": 3, "client_ms": 1.5, "frame_id": 7, "linear": 0.1, "angular": 0}

json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=8), inner, max_size=3),
    max_leaves=8,
)


def test_good_message_is_understood():
    message = parsed(json.dumps(DRIVE))
    assert isinstance(message, Drive)
    assert (message.seq, message.frame_id, message.linear, message.angular) == (3, 7, 0.1, 0.0)


@pytest.mark.parametrize(
    ("change", "problem"),
    [
        ({"linear": float("nan")}, "linear"),
        ({"linear": float("inf")}, "linear"),
        ({"linear": "0.1"}, "linear"),
        ({"linear": None}, "linear"),
        ({"frame_id": 0}, "frame_id"),
        ({"frame_id": 1.5}, "frame_id"),
        ({"client_ms": []}, "client_ms"),
        ({"speed": 1}, "speed"),
        ({"type": "fly"}, "fly"),
        ({"type": None}, "type"),
    ],
)
def test_refusal_names_the_field_and_keeps_the_number(change, problem):
    ack = parsed(json.dumps(DRIVE | change))
    assert isinstance(ack, Ack)
    assert not ack.ok
    assert ack.seq == 3
    assert problem in ack.reason


@pytest.mark.parametrize(
    ("raw", "problem"),
    [
        ("", "not JSON"),
        ("{", "not JSON"),
        ("[1]", "an array"),
        ("3", "a number"),
        ("null", "null"),
        ("[" * 5000, "not JSON"),
        (b"\x00\xff", "binary"),
        ("x" * (LONGEST_TEXT + 1), f"{LONGEST_TEXT + 1} characters"),
        ('{"type": "stop", "seq": 0, "reason": "key"}', "seq"),
        ('{"type": "stop", "seq": true, "reason": "key"}', "seq"),
    ],
)
def test_message_too_broken_for_a_number_is_refused_with_null(raw, problem):
    ack = parsed(raw)
    assert isinstance(ack, Ack)
    assert ack.seq is None
    assert problem in ack.reason


def test_long_wrong_value_is_not_echoed_whole():
    ack = parsed(json.dumps(DRIVE | {"linear": "9" * 5000}))
    assert isinstance(ack, Ack)
    assert len(ack.reason) < 200


@settings(max_examples=60, deadline=None)
@given(st.text() | st.binary() | json_values.map(json.dumps))
def test_anything_gives_a_message_or_a_refusal_with_a_reason(raw):
    result = parsed(raw)
    assert result.reason if isinstance(result, Ack) else result.seq >= 1


@given(st.dictionaries(st.sampled_from(list(DRIVE)), json_values))
def test_no_number_that_is_not_finite_passes(change):
    result = parsed(json.dumps(DRIVE | change))
    if isinstance(result, Drive):
        for value in (result.linear, result.angular, result.client_ms):
            assert abs(value) < float("inf")
