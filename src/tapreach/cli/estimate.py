"""`tapreach estimate`: a file of views to a position with its region."""

import json
import math
import sys
from dataclasses import fields
from pathlib import Path
from typing import Annotated

import typer

from tapreach.cli.estimate_file import EstimateFile, read_estimate_file
from tapreach.errors import InputError
from tapreach.estimation.map_estimator import estimate_point
from tapreach.estimation.point_estimate import PointEstimate
from tapreach.geometry.finite import FloatArray

_COMPUTED = (
    "point_in_world",
    "point_cov_in_world",
    "point_in_base",
    "point_cov_in_base",
    "is_ellipsoid_fair",
)
"""What a result computes when it is asked."""


def estimate(
    file: Annotated[str | None, typer.Argument(help="file.json, or - for standard input")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="print the result as JSON")] = False,
    schema: Annotated[bool, typer.Option("--schema", help="print the JSON schema of the file")] = False,
) -> None:
    """Estimate where a target is from views with known poses, with an honest region.

    Exit code 0 with a result of any status, 2 for a file that cannot be used.
    """
    if schema:
        typer.echo(json.dumps(EstimateFile.model_json_schema(), indent=2))
        return
    if file is None:
        raise InputError("no file given; give file.json, or - for standard input, or --schema")
    content = read_estimate_file(file, _read(file))
    result = estimate_point(
        content.observations(),
        content.motion(),
        mount_noise=content.mount_sigmas(),
        nuisances=content.nuisance_priors(),
        tap_noise=content.taps(),
        range_prior=content.prior(),
    )
    typer.echo(json.dumps(as_values(result), indent=2) if as_json else as_text(result))


def _read(file: str) -> str:
    try:
        return sys.stdin.read() if file == "-" else Path(file).read_text(encoding="utf-8")
    except OSError as error:
        raise InputError(f"{file}: {error.strerror}") from None
    except UnicodeDecodeError:
        raise InputError(f"{file}: not a text file in UTF-8") from None


def as_values(result: PointEstimate) -> dict[str, object]:
    """Return the result as plain values for JSON; infinity and what is not known become null."""
    names = [field.name for field in fields(PointEstimate) if field.name != "in_frames"]
    return {name: _plain(getattr(result, name)) for name in (*names, *_COMPUTED)}


def as_text(result: PointEstimate) -> str:
    """Return the result in a few lines for a person."""
    lines = [f"{result.status}: {result.reason}"]
    if result.point_in_world is not None and result.point_cov_in_world is not None:
        x, y, z = result.point_in_world
        sds = ", ".join(
            f"{100 * math.sqrt(variance):.2g}" for variance in result.point_cov_in_world.diagonal()
        )
        lines.append(f"position in the world: x {x:.4f}, y {y:.4f}, z {z:.4f} m (one sigma {sds} cm)")
    if result.range is not None:
        lines.append(f"range: {result.range:.4f} m from the first camera")
    if result.range_interval_95 is not None:
        low, high = result.range_interval_95
        lines.append(f"95 % range: {low:.3f} m " + ("or more" if high is None else f"to {high:.3f} m"))
    if result.rejected_views:
        lines.append(f"left out, as they do not fit: views {', '.join(map(str, result.rejected_views))}")
    return "\n".join([*lines, f"advice: {result.advice}"])


def _plain(value: object) -> object:
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, tuple):
        return [_plain(each) for each in value]
    if hasattr(value, "tolist"):
        return _plain_array(value)  # type: ignore[arg-type]
    return value


def _plain_array(array: FloatArray) -> object:
    return [_plain(tuple(row) if isinstance(row, list) else row) for row in array.tolist()]
