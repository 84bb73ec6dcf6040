"""Pictures of the fetches that went wrong: a strip for each, with its phases and the reason."""

import textwrap
from dataclasses import dataclass
from pathlib import Path

from tapreach.bench.contact_sheet import RED, decoded, ring, write_strip
from tapreach.bench.fetch_outcome import FetchOutcome
from tapreach.geometry.finite import FloatArray

_LETTERS, _LOG_LINES, _NOTE_LINES = 92, 2, 3


@dataclass(frozen=True)
class Glimpse:
    """The tapped frame with the tapped pixel (2,) [px], and the last frame; both JPEG."""

    tapped_jpeg: bytes
    pixel: FloatArray
    last_jpeg: bytes


def write_glimpse(folder: Path, glimpse: Glimpse, outcome: FetchOutcome) -> None:
    """Write the tapped frame, the tap ringed in red, beside the last one, under what happened."""
    pictures = [decoded(glimpse.tapped_jpeg), decoded(glimpse.last_jpeg)]
    ring(pictures[0], glimpse.pixel, RED)
    lines = [_head(outcome), *_wrapped(outcome.log, _LOG_LINES), *_wrapped(_note(outcome), _NOTE_LINES)]
    write_strip(folder / f"{outcome.chapter}_{outcome.number:04d}_{_plain(outcome.arm)}.png", pictures, lines)


def _head(outcome: FetchOutcome) -> str:
    said = "said held" if outcome.claims_held else f"ended at {outcome.phase}"
    truth = "is held" if outcome.is_held else f"is not held, lifted {1000.0 * outcome.lift:.0f} mm"
    way = "" if outcome.is_way_free else ", way not free"
    what = (
        f"{outcome.chapter} {outcome.number} {outcome.scene}: {outcome.thing}, {outcome.distance:.2f} m{way}"
    )
    return f"{what}: {said}, {truth}"


def _note(outcome: FetchOutcome) -> str:
    moved = f" Moved: {', '.join(outcome.others_moved)}." if outcome.others_moved else ""
    stop = outcome.stop
    stopped = f" Stopped at {stop.seconds:.1f} s in {stop.phase}." if stop is not None else ""
    return f"{outcome.state}: {outcome.note}.{moved}{stopped}"


def _wrapped(text: str, most: int) -> list[str]:
    """Return always so many lines, so that strips are of one height."""
    lines = textwrap.wrap(text, _LETTERS)[:most]
    return lines + [""] * (most - len(lines))


def _plain(words: str) -> str:
    return words.replace(" ", "_").replace(",", "")
