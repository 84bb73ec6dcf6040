"""From the outcomes of fetches to figures with their limits: a section for each chapter, and what failed."""

import math
from collections.abc import Callable, Sequence
from typing import TypeVar

from tapreach.bench.control_stop import AT_ONCE_MS
from tapreach.bench.fetch_method import ARMS_METHOD, METHOD, TITLE
from tapreach.bench.fetch_outcome import FetchOutcome, StopOutcome
from tapreach.bench.fetch_plan import Chapter
from tapreach.bench.fetch_table import COLUMNS, cells, grid, reasons
from tapreach.bench.fetch_ungraspable import Hindrance
from tapreach.bench.figure import Figure, at_least, at_most, exactly, known
from tapreach.bench.grid import Grid
from tapreach.bench.locate_table import at
from tapreach.bench.report import Section

Each = TypeVar("Each")
FLUNG = 0.02
"""What moves farther after a stop was thrown [m]."""
_ABOUT_M = (1.2, 1.8)
"""What counts as about 1.5 m."""


def chapter_section(chapter: Chapter, own: Sequence[FetchOutcome]) -> Section:
    """Return the figures of a chapter from its runs (of the whole task, not of other arms)."""
    figures, table = _FIGURES[chapter](own)
    return Section(TITLE[chapter], METHOD[chapter], figures, table)


def reasons_section(chapter: Chapter, own: Sequence[FetchOutcome]) -> Section:
    """Return why runs of a chapter went wrong."""
    title = f"{TITLE[chapter]}: what went wrong"
    wrong = Figure("runs in which something went wrong", sum(not each.is_good for each in own))
    return Section(
        title, "The last phases and the robot's own words, without numbers.", (wrong,), reasons(own)
    )


def beside_section(outcomes: Sequence[FetchOutcome]) -> Section:
    """Return the table of every arm on the same taps: those that all were run on."""
    arms = list(dict.fromkeys(outcome.arm for outcome in outcomes))
    runs = set.intersection(*({each.number for each in outcomes if each.arm == arm} for arm in arms))
    shared = [outcome for outcome in outcomes if outcome.number in runs]
    rows = tuple((arm, *cells([each for each in shared if each.arm == arm])) for arm in arms)
    figures = tuple(_share_held(arm, [each for each in shared if each.arm == arm]) for arm in arms)
    return Section("What each part contributes", ARMS_METHOD, figures, Grid(("what is done", *COLUMNS), rows))


def _share_held(arm: str, own: Sequence[FetchOutcome]) -> Figure:
    held = _percent(own, lambda each: each.is_held)
    return Figure(f"{arm}: lifted and held for 2 s", held, "%", note=f"{len(own)} runs")


def _fetched(own: Sequence[FetchOutcome], least: float) -> tuple[tuple[Figure, ...], Grid]:
    free = [each for each in own if each.is_way_free]
    near = [each for each in own if _ABOUT_M[0] <= each.distance <= _ABOUT_M[1] and each.is_held]
    times = [each.lifted_after for each in near if each.lifted_after is not None]
    chance = 100.0 * math.sqrt(least / 100.0 * (1.0 - least / 100.0) / max(len(own), 1))
    held = _percent(own, lambda each: each.is_held)
    figures = (
        Figure("runs", len(own)),
        Figure("lifted and held for 2 s", held, "%", at_least(least), f"standard error {chance:.1f} %"),
        Figure("... where the straight way is free", _percent(free, lambda each: each.is_held), "%",
               note=f"{len(free)} runs"),
        _false_claims(own),
        Figure("tap to lifted at about 1.5 m: median", known(at(times, 50.0)), "s",
               at_most(40.0) if least > 90.0 else None,
               f"{len(times)} runs from {_ABOUT_M[0]:g} to {_ABOUT_M[1]:g} m"),
        _others(own, None),
        *_costs(own),
    )  # fmt: skip
    return figures, grid(own)


def _refused(own: Sequence[FetchOutcome]) -> tuple[tuple[Figure, ...], Grid]:
    figures = (
        Figure("things", len(own)),
        Figure("rightly refused", _percent(own, lambda each: each.is_truly_refused), "%", at_least(95.0)),
        Figure("refused at all", _percent(own, lambda each: each.is_refused), "%"),
        Figure("driven into something", sum(each.most_moved >= 0.005 for each in own)),
        _false_claims(own),
        *_costs(own),
    )
    rows = tuple(_hindrance_row(each, [one for one in own if one.hindrance is each]) for each in Hindrance)
    return figures, Grid(("why it cannot be grasped", "things", "rightly refused", "refused"), rows)


def _hindrance_row(hindrance: Hindrance, part: Sequence[FetchOutcome]) -> tuple[str, ...]:
    right, refused = (sum(each.is_truly_refused for each in part), sum(each.is_refused for each in part))
    return str(hindrance), str(len(part)), str(right), str(refused)


def _stopped(own: Sequence[FetchOutcome]) -> tuple[tuple[Figure, ...], Grid]:
    stops = [each.stop for each in own if each.stop is not None]
    in_claw = [each for each in stops if each.was_held]
    figures = (
        Figure("stops", len(stops), note=f"{len(own) - len(stops)} runs ended before"),
        Figure("zero to the wheels: longest", known(max((s.zero_ms for s in stops), default=math.nan)), "ms",
               at_most(AT_ONCE_MS), "the table's 'at once': one period of the control loop"),
        Figure("base at rest: longest", known(max((s.rest_ms for s in stops), default=math.nan)), "ms",
               note="by the truth, to 0.1 s"),
        Figure("dropped out of the claw", sum(not each.is_held for each in in_claw), "", exactly(0),
               f"of {len(in_claw)} that were in it, off the floor"),
        Figure("moved by more than 2 cm after a stop", sum(each.flung > FLUNG for each in stops), "",
               exactly(0)),
        Figure("resumed, lifted and held", _percent(stops, lambda each: each.resumed), "%", at_least(90.0)),
        _false_claims(own),
        *_costs(own),
    )  # fmt: skip
    return figures, _by_phase(stops)


def _by_phase(stops: Sequence[StopOutcome]) -> Grid:
    rows = []
    for phase in dict.fromkeys(each.phase for each in stops):
        part = [each for each in stops if each.phase == phase]
        rest = max(each.rest_ms for each in part)
        rows.append((phase, str(len(part)), str(sum(each.resumed for each in part)), f"{rest:.0f} ms"))
    return Grid(("stopped in", "stops", "resumed, lifted and held", "at rest after, longest"), tuple(rows))


def _cluttered(own: Sequence[FetchOutcome]) -> tuple[tuple[Figure, ...], Grid]:
    figures = (
        Figure("runs", len(own)),
        _others(own, 5.0),
        Figure("lifted and held for 2 s", _percent(own, lambda each: each.is_held), "%"),
        _false_claims(own),
        *_costs(own),
    )
    return figures, grid(own)


_FIGURES: dict[Chapter, Callable[[Sequence[FetchOutcome]], tuple[tuple[Figure, ...], Grid]]] = {
    Chapter.DEFAULT: lambda own: _fetched(own, 95.0),
    Chapter.HARD: lambda own: _fetched(own, 85.0),
    Chapter.REFUSALS: _refused,
    Chapter.STOPS: _stopped,
    Chapter.CLUTTER: _cluttered,
}


def _false_claims(own: Sequence[FetchOutcome]) -> Figure:
    said = sum(each.claims_held and not each.is_held for each in own)
    return Figure(
        "false claims",
        _percent(own, lambda each: each.is_false_claim),
        "%",
        at_most(1.0),
        f'{said} times "held" of what is not',
    )


def _others(own: Sequence[FetchOutcome], most: float | None) -> Figure:
    limit = None if most is None else at_most(most)
    moved = _percent(own, lambda each: bool(each.others_moved))
    return Figure("runs that moved what was not meant by more than 2 cm", moved, "%", limit)


def _costs(own: Sequence[FetchOutcome]) -> tuple[Figure, ...]:
    simulated, took = sum(each.seconds for each in own), sum(each.wall_seconds for each in own)
    return (Figure("simulated over real time", simulated / took if took else None),)


def _percent(part: Sequence[Each], is_so: Callable[[Each], bool]) -> float | None:
    return 100.0 * sum(map(is_so, part)) / len(part) if part else None
