"""Pictures of the taps that went wrong: a strip for each."""

from pathlib import Path

from tapreach.bench.contact_sheet import GREEN, RED, decoded, ring, write_strip
from tapreach.bench.locate_outcome import Outcome
from tapreach.geometry.finite import FloatArray


def write_glimpse(
    folder: Path,
    outcome: Outcome,
    first: tuple[bytes, FloatArray],
    last: tuple[bytes, FloatArray],
    followed: FloatArray | None,
) -> None:
    """Write the tapped frame beside the last one, each JPEG with the true place (2,) [px] ringed in red; in
    green where it was last followed to.
    """
    pictures = [decoded(jpeg) for jpeg, _ in (first, last)]
    for picture, (_, pixel) in zip(pictures, (first, last), strict=True):
        ring(picture, pixel, RED)
    if followed is not None:
        ring(pictures[1], followed, GREEN)
    error = "refused" if outcome.range_error is None else f"{100.0 * outcome.range_error:+.1f} %"
    lines = (
        f"{outcome.tap} {outcome.scene}: {outcome.thing}, {outcome.distance:.2f} m, {outcome.arm}: {error}",
        outcome.note,
    )
    write_strip(folder / f"{outcome.tap:04d}_{outcome.arm.replace(' ', '_')}.png", pictures, lines)
