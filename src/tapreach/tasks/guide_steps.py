"""The tables of the guided procedures, as the paper orders them."""

from math import radians

from tapreach.tasks.guide_state import GuideKind, Step

TURN = radians(12.0)
"""The paper's turn to the left [rad]."""
ADVANCE = 0.20
"""The paper's advance [m]."""
CHECK_TURN = radians(10.0)
"""The turn of the rotation centre check [rad]."""

_POSE = Step(
    "pose",
    "Standard pose",
    "Bring the arm to its standard pose, so that the camera looks ahead freely.",
    act="pose",
)

TWO_TAP = (
    _POSE,
    Step(
        "centre",
        "Centre the target",
        "Turn until the target stands on the centre line. Tap it to be told how far to turn.",
        act="centre",
        wants_tap=True,
    ),
    Step(
        "first",
        "First tap",
        "Tap the target, at a spot you will find again.",
        wants_tap=True,
        needs_tap=True,
    ),
    Step(
        "turn",
        "Turn left",
        "Turn 12° to the left on the spot. The target must stay in the picture.",
        act="turn",
    ),
    Step("advance", "Advance", "Drive 20 cm straight ahead.", act="advance"),
    Step("second", "Second tap", "Tap the same spot of the target again.", wants_tap=True, needs_tap=True),
)

ROTATION_CENTRE = (
    _POSE,
    Step(
        "near",
        "Near point",
        "Choose two things on the floor near the centre line, one near, one far. Tap the near one's foot.",
        wants_tap=True,
        needs_tap=True,
    ),
    Step("far", "Far point", "Tap the foot of the far one.", wants_tap=True, needs_tap=True),
    Step("turn", "Turn left", "Turn 10° to the left on the spot.", act="turn"),
    Step("near_again", "Near point again", "Tap the near spot again.", wants_tap=True, needs_tap=True),
    Step("far_again", "Far point again", "Tap the far spot again.", wants_tap=True, needs_tap=True),
)

TABLES: dict[GuideKind, tuple[Step, ...]] = {
    GuideKind.TWO_TAP: TWO_TAP,
    GuideKind.ROTATION_CENTRE: ROTATION_CENTRE,
}
