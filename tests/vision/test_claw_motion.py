"""The claw is found by what moved, whatever it looks like; what was not seen is said to be not seen."""

import numpy as np
import pytest

from tapreach.errors import InputError
from tapreach.vision.claw_motion import ClawPart, NotSeen, SeenPart, change_between, seen_parts
from tapreach.vision.image_io import Color
from vision.synthetic import texture, view

FINGER = np.array([(0.0, 0.0), (16.0, 0.0), (16.0, 50.0), (0.0, 50.0)])
AT = {"left finger of the open claw": (200, 250), "right finger of the open claw": (360, 250)}
NARROW = {"left finger of the narrow claw": (245, 250), "right finger of the narrow claw": (315, 250)}


def picture(fingers: dict[str, tuple[int, int]], shade: int = 20, gain: float = 1.0) -> Color:
    background = np.clip(90.0 + 0.5 * view(texture(3))[0], 0, 255) * gain
    drawn = np.repeat(background[:, :, None], 3, axis=2).astype(np.uint8)
    for u, v in fingers.values():
        drawn[v : v + 120, u : u + 17] = round(shade * gain)
    return drawn


def expected(shift: tuple[float, float] = (0.0, 0.0)) -> list[ClawPart]:
    places = {**AT, **NARROW}
    return [
        ClawPart(name, FINGER + place + shift, np.array([8.0, 0.0]) + place + shift)
        for name, place in places.items()
    ]


@pytest.mark.parametrize("shift", [(0.0, 0.0), (23.0, -31.0), (-90.0, 60.0)])
def test_fingers_are_found_where_they_are(shift: tuple[float, float]) -> None:
    change = change_between(picture(AT), picture(NARROW))
    found = seen_parts(change, expected(shift), 140)
    assert not isinstance(found, NotSeen)
    for part, (u, v) in zip(found, (AT | NARROW).values(), strict=True):
        assert isinstance(part, SeenPart)
        assert np.abs(part.mark - (u + 8.0, v)).max() < 1.5


def test_picture_that_is_brighter_as_a_whole_has_not_changed() -> None:
    change = change_between(picture({}), picture({}, gain=0.9))
    assert np.quantile(change, 0.95) < 3.0


def test_claw_that_did_not_move_is_not_seen() -> None:
    found = seen_parts(change_between(picture(AT), picture(AT)), expected(), 140)
    assert isinstance(found, NotSeen)
    assert "nothing moved" in found.reason


def test_finger_that_is_hidden_is_not_seen_and_the_others_are() -> None:
    change = change_between(picture(AT), picture(NARROW))
    change[:, 362:] = 0.0
    found = seen_parts(change, expected(), 30)
    assert not isinstance(found, NotSeen)
    hidden = [part for part in found if isinstance(part, NotSeen)]
    assert len(hidden) == 1
    assert "right finger" in hidden[0].reason


def test_something_else_that_moved_is_not_taken_for_the_claw() -> None:
    before, after = picture({}), picture({})
    after[200:420, 150:450] = 90
    found = seen_parts(change_between(before, after), expected(), 60)
    assert isinstance(found, NotSeen)


def test_pictures_of_different_size_cannot_be_compared() -> None:
    with pytest.raises(InputError, match="cannot be compared"):
        change_between(picture({}), picture({})[:100])
