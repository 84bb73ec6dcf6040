"""Whether a thing can be gripped at all, by its size and height, and how it would be gripped."""

import math
from dataclasses import dataclass
from enum import StrEnum
from functools import lru_cache

from tapreach.tasks.fetch.claw_room import Claw
from tapreach.tasks.fetch.thing import ThingSize

SURE = 2.0
"""Sizes count as told where they hold with this many sigmas to spare."""
DENIED = 3
"""What was measured once, and so often had no sides of its own since, is part of something larger."""
FAR = 3.0
"""Sigmas beyond which no other look makes a width doubtful."""
CLAW_SPARE = 0.004
"""The claw must open by this much more than the thing is wide [m]."""
BESIDE = 0.01
"""So much the claw opens beyond each side of the thing, where it can [m]."""
BEFORE_FRONT = 0.01
"""Way between the finger tips and the thing's front until the arm goes out [m]."""
LEAST_ROOM = 0.01
"""The arm must reach this much farther and less far than it is meant to [m]."""
BITE = 0.006
"""The gripping point lies this much below the thing's top and above its foot [m], where it can."""
OFF_FLOOR = 0.03
"""What begins higher above the floor stands on something or hangs [m]."""
WORTH_LOOKING = 0.1
"""Another side is looked for where the thing fits the claw with so much greater a probability."""
WORTH_TRYING = 0.2
"""So probable a fit is tried where no other side is better: four grasps in vain cost less than a fetch."""
_HEIGHT_STEP = 0.01


class Verdict(StrEnum):
    """Whether it can be fetched."""

    YES = "yes"
    NO = "no"
    UNSURE = "unsure"


@dataclass(frozen=True)
class Grip:
    """How the claw takes a thing, level. Ways are those of the gripping point from the turret's axis [m].

    height: of the gripping point above the floor. opening: of the claw before it closes. ahead: to the
    thing's middle, halfway between the nearest place at which the claw still fits in before its front and the
    farthest that the arm reaches. spare: how much nearer or farther the thing may be. pre_grasp: where the
    claw waits before its front. half_depth: from its front to its middle; supposed, as half its width.
    """

    height: float
    opening: float
    ahead: float
    spare: float
    pre_grasp: float
    half_depth: float


@dataclass(frozen=True)
class Judgement:
    """Yes, no, or unsure; why; what would help ('' for nothing), and the grip unless there is none."""

    verdict: Verdict
    reason: str
    advice: str
    grip: Grip | None
    from_another_side: bool = False
    """It is too wide as seen from here alone: only another side can help."""


def judge(
    size: ThingSize, claw: Claw, is_last_look: bool = False, seeks_another_side: bool = True
) -> Judgement:
    """Return whether a thing of this size can be gripped.

    is_last_look: it will not be measured better; what the widths themselves say then counts, and what may fit
    is tried. seeks_another_side: what is too wide may be looked at from where it is narrower.
    """
    grip = grip_for(size, claw)
    refused = _too_high(size, claw) or _too_flat(size, claw)
    refused = refused or _too_wide(size, claw, is_last_look, seeks_another_side)
    if (size.goes_on_above or size.is_post) and (refused is None or refused.verdict is Verdict.UNSURE):
        return _no(_endless(size), "draw a box around it if it does end there")
    if refused is not None:
        return refused
    if is_last_look and size.told == 1 and size.denied >= DENIED:
        return _no(_without_sides(size), "draw a box around it if it is a thing by itself")
    if grip is None and size.width > claw.opens_to:
        return _no(_wider_by(size, claw), "")
    if grip is None:
        return _no(f"the claw does not get around it at any height from {_mm(claw.lowest)} up", "")
    doubt = _doubtful_stand(size, grip) or _doubtful_width(size, claw, grip, is_last_look)
    return doubt or Judgement(Verdict.YES, in_words(size, grip, claw), "", grip)


def grip_for(size: ThingSize, claw: Claw, rotation: float = 0.0) -> Grip | None:
    """Return the grip nearest to the thing's middle height; None where the arm has no room for one."""
    opening = min(claw.opens_to, size.width + SURE * size.width_sd + 2.0 * BESIDE)
    highest = max(claw.lowest, size.foot + size.height - BITE)
    middle = min(max(size.foot + size.height / 2.0, claw.lowest), highest)
    lowest = max(claw.lowest, min(size.foot + BITE, middle))
    for down in range(1 + math.floor((middle - lowest) / _HEIGHT_STEP + 1e-9)):
        grip = _grip_at(middle - down * _HEIGHT_STEP, size.width / 2.0, opening, claw, rotation)
        if grip is not None:
            return grip
    return None


@lru_cache(maxsize=64)
def highest_grip(half_depth: float, claw: Claw) -> float | None:
    """Return the greatest height at which something so deep can be gripped and lifted [m]; None for none."""
    steps = math.ceil(2.0 * claw.longest / _HEIGHT_STEP)
    downward = (claw.lowest + i * _HEIGHT_STEP for i in range(steps, -1, -1))
    can = (h for h in downward if _grip_at(h, half_depth, claw.opens_to, claw, 0.0) is not None)
    return next(can, None)


def in_words(size: ThingSize, grip: Grip, claw: Claw) -> str:
    """Return what is going to be done, such as '50 mm wide, 90 mm high: gripped 40 mm above the floor'."""
    known = f"{_mm(size.width)} wide, {_mm(size.height)} high"
    if size.width > claw.opens_to:
        known = f"may be too wide, and is tried: {known}"
    return f"{known}: gripped {_mm(grip.height)} above the floor; its weight is not known"


def _grip_at(height: float, half_depth: float, opening: float, claw: Claw, rotation: float) -> Grip | None:
    room = claw.room(height, opening, rotation)
    if room is None:
        return None
    to_front = half_depth + claw.beyond + BEFORE_FRONT
    nearest, farthest = room.nearest + to_front, room.farthest
    spare = (farthest - nearest) / 2.0
    if spare < LEAST_ROOM:
        return None
    ahead = (nearest + farthest) / 2.0
    return Grip(height, opening, ahead, spare, ahead - to_front, half_depth)


def _too_high(size: ThingSize, claw: Claw) -> Judgement | None:
    if size.foot <= OFF_FLOOR:
        return None
    half_depth = min(size.width, claw.opens_to) / 2.0
    highest = highest_grip(half_depth, claw)
    if highest is None or size.foot + BITE <= highest:
        return None
    begins = f"it begins {_mm(size.foot)} above the floor"
    words = f"too high: the claw reaches {_mm(highest)}, {begins}"
    if size.foot + BITE - SURE * size.height_sd > highest:
        return _no(words, "bring it lower")
    nearer = f"drive nearer: its height is known to ±{_mm(SURE * size.height_sd)} only"
    return Judgement(Verdict.UNSURE, f"may be {words}", nearer, None)


def _too_flat(size: ThingSize, claw: Claw) -> Judgement | None:
    top = size.foot + size.height
    lacking = claw.lowest - claw.arm.shape.hand_radius / 2.0 - top
    if lacking <= 0.0:
        return None
    words = f"too flat: its top is {_mm(top)} above the floor, the claw grips from {_mm(claw.lowest)} up"
    if lacking > SURE * size.height_sd:
        return _no(words, "")
    nearer = f"drive nearer: its height is known to ±{_mm(SURE * size.height_sd)} only"
    return Judgement(Verdict.UNSURE, f"may be {words}", nearer, None)


def is_narrower_elsewhere(size: ThingSize, claw: Claw) -> bool:
    """Tell whether what is too wide fits the claw more probably from another side, as a box does that is seen
    over its corner.
    """
    if size.width <= claw.opens_to:
        return False
    best = size.footprint.best_fit(claw.opens_to)
    return best - size.fits(claw.opens_to) >= WORTH_LOOKING


def _too_wide(size: ThingSize, claw: Claw, is_last_look: bool, seeks: bool) -> Judgement | None:
    opens = claw.opens_to
    if size.width <= opens:
        return None
    if seeks and is_narrower_elsewhere(size, claw):
        side = "look at it from another side: a box is narrower there than over its corner"
        words = f"{_mm(size.width - opens)} too wide for the claw as seen from here"
        return Judgement(Verdict.UNSURE, words, side, grip_for(size, claw), from_another_side=True)
    is_far_too_wide = size.width - FAR * size.width_sd > opens
    is_told = is_last_look or size.width - SURE * size.width_sd > opens
    is_in_vain = is_far_too_wide or size.fits(opens) < WORTH_TRYING
    return _no(_wider_by(size, claw), "") if is_told and is_in_vain else None


def _endless(size: ThingSize) -> str:
    up_to = _mm(size.foot + size.height)
    if not size.goes_on_above:
        larger = "probably part of something larger, as the leg of a chair or a picture on a wall is"
        return f"it is {_mm(size.width)} wide and {up_to} high: {larger}"
    larger = "part of something larger, as a picture on a wall is, or stands on something"
    return f"it goes on above {up_to}: {larger}"


def _without_sides(size: ThingSize) -> str:
    larger = "it may be part of something larger, as a picture on a wall is"
    return f"looked {_mm(size.width)} wide once, and has no sides of its own since: {larger}"


def _wider_by(size: ThingSize, claw: Claw) -> str:
    too_much = f"{_mm(size.width - claw.opens_to)} too wide for the claw"
    return f"{too_much}: it is {_mm(size.width)} wide, the claw opens to {_mm(claw.opens_to)}"


def _doubtful_stand(size: ThingSize, grip: Grip) -> Judgement | None:
    if size.foot <= OFF_FLOOR + SURE * size.height_sd:
        return None
    words = (
        f"begins {_mm(size.foot)} above the floor: it hangs, or stands on something that may be in the way"
    )
    return Judgement(Verdict.UNSURE, words, "put it on the floor", grip)


def _doubtful_width(size: ThingSize, claw: Claw, grip: Grip, is_last_look: bool) -> Judgement | None:
    fits, needed = claw.opens_to - CLAW_SPARE, size.width + SURE * size.width_sd
    if needed <= fits or is_last_look:
        return None
    known = f"{_mm(size.width)} ± {_mm(SURE * size.width_sd)} wide, the claw opens to {_mm(claw.opens_to)}"
    if size.width_sd < CLAW_SPARE / SURE:
        return Judgement(Verdict.UNSURE, f"fits the claw barely: {known}", "", grip)
    nearer = f"drive nearer: its width is known to ±{_mm(SURE * size.width_sd)} only"
    return Judgement(Verdict.UNSURE, f"may be too wide: {known}", nearer, grip)


def _no(reason: str, advice: str) -> Judgement:
    return Judgement(Verdict.NO, reason, advice, None)


def _mm(metres: float) -> str:
    return f"{1000.0 * metres:.0f} mm"
