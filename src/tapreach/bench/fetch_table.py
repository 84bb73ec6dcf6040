"""Tables of fetches by distance, by scene or by what is to be told apart, and why they went wrong."""

import itertools
from collections.abc import Callable, Sequence

from tapreach.bench.fetch_outcome import FetchOutcome
from tapreach.bench.grid import Grid
from tapreach.bench.locate_table import at

_DISTANCES = (0.5, 1.0, 1.5, 2.0, 3.0)
_NOTHING = "—"
COLUMNS = (
    "runs", "lifted and held", "at the first try", "refused", "said held, is not", "not said, is held",
    "moved others", "tap to lifted: median", "95 %",
)  # fmt: skip


def grid(own: Sequence[FetchOutcome]) -> Grid:
    """Return the table by distance, and by whether the way is free."""
    rows = []
    for low, high in itertools.pairwise(_DISTANCES):
        part = [each for each in own if low <= each.distance < high]
        rows.append((f"{low:g} to {high:g} m", *cells(part)))
    for words, is_free in (("way free", True), ("something in the straight way", False)):
        rows.append((words, *cells([each for each in own if each.is_way_free is is_free])))
    return Grid(("", *COLUMNS), tuple(rows))


def cells(part: Sequence[FetchOutcome]) -> tuple[str, ...]:
    """Return the cells of a row, under COLUMNS."""
    times = [each.lifted_after for each in part if each.lifted_after is not None and each.is_held]
    return (
        str(len(part)),
        _count(part, lambda each: each.is_held),
        _count(part, lambda each: each.is_held and each.attempt == 1),
        _count(part, lambda each: each.is_refused),
        _count(part, lambda each: each.claims_held and not each.is_held),
        _count(part, lambda each: each.is_denied or (each.is_held and not each.claims_held)),
        _count(part, lambda each: bool(each.others_moved)),
        f"{at(times, 50.0):.1f} s" if times else _NOTHING,
        f"{at(times, 95.0):.1f} s" if times else _NOTHING,
    )


def reasons(own: Sequence[FetchOutcome]) -> Grid:
    """Return why runs went wrong: the phase at which they ended, and the words, the most frequent first."""
    counts: dict[tuple[str, str], int] = {}
    for each in own:
        if not each.is_good:
            key = _where(each), _words(each)
            counts[key] = counts.get(key, 0) + 1
    rows = sorted(counts.items(), key=lambda pair: -pair[1])
    return Grid(("runs", "ended", "why"), tuple((str(count), *key) for key, count in rows))


def _count(part: Sequence[FetchOutcome], is_so: Callable[[FetchOutcome], bool]) -> str:
    return str(sum(map(is_so, part))) if part else _NOTHING


def _where(outcome: FetchOutcome) -> str:
    """Return the last phase in which something was done, and how it ended."""
    done = [each.phase for each in outcome.phases[:-1]]
    return f"{outcome.phase} after {done[-1]}" if done else outcome.phase


def _words(outcome: FetchOutcome) -> str:
    """Return the reason without its numbers, so that equal ones are counted together."""
    words = outcome.note.split(". ")[0].split("; ")[0]
    plain_words = "".join("N" if letter.isdigit() else letter for letter in words)
    while "NN" in plain_words or "N.N" in plain_words:
        plain_words = plain_words.replace("NN", "N").replace("N.N", "N")
    moved = "; moved what was not meant" if outcome.others_moved else ""
    return f"{plain_words}{moved}"
