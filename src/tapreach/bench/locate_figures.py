"""From the outcomes of all taps to figures with their limits, and to tables by distance and by scene."""

import math
from collections.abc import Sequence

from tapreach.bench.figure import Figure, at_least, at_most, known
from tapreach.bench.grid import Grid
from tapreach.bench.locate_outcome import Outcome
from tapreach.bench.locate_plan import Arm
from tapreach.bench.locate_table import (
    COLUMNS,
    at,
    cells,
    grid,
    mean,
    percent,
    position_error,
    range_error,
    share,
)
from tapreach.bench.report import Section


def arm_section(arm: Arm, outcomes: Sequence[Outcome], is_held: bool) -> Section:
    """Return the figures of one arm, held to the limits or not, and its table by distance and scene."""
    own = [outcome for outcome in outcomes if outcome.arm == arm]
    figures = _figures(own)
    if not is_held:
        figures = tuple(Figure(each.name, each.value, each.unit, note=each.note) for each in figures)
    return Section(_title(arm), _METHOD[arm], figures, grid(own))


def beside_section(outcomes: Sequence[Outcome]) -> Section:
    """Return the table of every arm on the same taps: those that all were run on."""
    arms = list(dict.fromkeys(outcome.arm for outcome in outcomes))
    taps = set.intersection(*({each.tap for each in outcomes if each.arm == arm} for arm in arms))
    shared = [outcome for outcome in outcomes if outcome.tap in taps]
    rows = tuple((arm, *cells([each for each in shared if each.arm == arm])) for arm in arms)
    return Section(
        "Beside the paper's fixed move",
        "The same taps. Fixed move: the arm is brought to its pose, 12° and 20 cm as in the paper; our "
        "estimator with the background. Paper's formula: its closed form (eq. 7) on the same two pixels, "
        "with turn and advance as the wheels say them; it takes the camera for level and on the axis, and "
        "has no region.",
        (),
        Grid(("what is done", *COLUMNS), rows),
    )


def _title(arm: Arm) -> str:
    return {
        Arm.CHOSEN: "One tap, chosen moves",
        Arm.WITHOUT_BACKGROUND: "The same without the background",
        Arm.FIXED: "The paper's fixed move, our estimator",
    }[arm]


_WHAT = (
    "Refused: no position although the thing was in sight. Wrong: off by more than 5 % of the range and "
    "outside its own 99.9 % region. Range: from the camera of the tapped frame. Position: in the frame of "
    "the base where the robot came to rest. Time: simulated, computing not counted."
)
_METHOD = {
    Arm.CHOSEN: "The whole task as the page starts it, in the rendered simulator in simulated time; a thing, "
    "a distance of 0.5 to 3 m, a side and a place on it are drawn for each tap, and the faults anew: all "
    "distances by the wheels wrong by 1 % and all turns by 1 % (sigma), each wheel slipping 0 to 2 %, the "
    "camera turned by 1° and moved by 5 mm in any direction, JPEG 80; dark scenes with noise and blur. "
    + _WHAT,
    Arm.WITHOUT_BACKGROUND: "The turn is left to the wheels.",
    Arm.FIXED: "12° and 20 cm, the first and the last view, and the background in between.",
}


def _figures(own: Sequence[Outcome]) -> tuple[Figure, ...]:
    answered = [outcome for outcome in own if outcome.is_answered]
    ranges, positions = list(map(range_error, answered)), list(map(position_error, answered))
    interval = 100.0 * share(answered, lambda each: bool(each.holds_range))
    position = 100.0 * share(answered, lambda each: each.holds_position)
    bearing = 100.0 * share(answered, lambda each: each.holds_bearing_depth)
    chance = f"standard error {100.0 * math.sqrt(0.95 * 0.05 / max(len(answered), 1)):.1f} %"
    wheels = percent([abs(each.scale - 1.0) for each in answered], 50.0)
    times = [outcome.seconds for outcome in own]
    return (
        Figure("taps", len(own), note=f"{len(answered)} with a position"),
        Figure("range error: median", known(percent(ranges, 50.0)), "%", at_most(1.0),
               f"the way by the wheels alone is off by {wheels:.1f} %"),
        Figure("range error: 95 %", known(percent(ranges, 95.0)), "%", at_most(4.0)),
        Figure("position error: median", known(percent(positions, 50.0)), "%", at_most(1.0),
               "a mount turned by 1° alone makes 1.4 %"),
        Figure("position error: 95 %", known(percent(positions, 95.0)), "%", at_most(4.0)),
        Figure("95 % range interval holds, at least", known(interval), "%", at_least(93.0), chance),
        Figure("95 % range interval holds, at most", known(interval), "%", at_most(97.0)),
        Figure("95 % region of the position holds, at least", known(position), "%", at_least(93.0), chance),
        Figure("95 % region of the position holds, at most", known(position), "%", at_most(97.0)),
        Figure("95 % region in (bearing, 1/Z) holds", known(bearing), "%",
               note="the bearing cannot err: the truth is what lies under the tapped pixel"),
        Figure("NEES of 1/Z", known(mean([each.nees_depth for each in answered])),
               note="1 where what is said is as wide as the errors"),
        Figure("NEES/3 of the position", known(mean([each.nees_position for each in answered]) / 3.0)),
        Figure("refused", known(100.0 * share(own, lambda each: not each.is_answered)), "%", at_most(3.0),
               _reasons(own)),
        Figure("wrong without saying so", known(100.0 * share(own, lambda each: each.is_wrong)), "%",
               at_most(1.0)),
        Figure("time from tap to answer: median", known(at(times, 50.0)), "s"),
        Figure("time from tap to answer: 95 %", known(at(times, 95.0)), "s"),
    )  # fmt: skip


def _reasons(own: Sequence[Outcome]) -> str:
    """Return why there was no position, the most frequent reason first."""
    counts: dict[str, int] = {}
    for outcome in own:
        if not outcome.is_answered:
            reason = outcome.status if outcome.status != "failed" else outcome.note.split(". ")[0]
            counts[reason] = counts.get(reason, 0) + 1
    return "; ".join(
        f"{count} {reason}" for reason, count in sorted(counts.items(), key=lambda pair: -pair[1])
    )
