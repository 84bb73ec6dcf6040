"""`tapreach two-tap`: the paper's closed form from numbers, and its tables anew."""

import math
from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table

from tapreach.cli.quantity import read_angle, read_focal_px, read_length, read_tap
from tapreach.errors import InputError
from tapreach.estimation.paper_tables import TABLE_1, TABLE_2
from tapreach.estimation.two_tap import ScreenOffset, TwoTapEstimate, TwoTapPosition
from tapreach.estimation.two_tap import two_tap as estimate_two_tap
from tapreach.geometry.finite import FloatArray
from tapreach.geometry.planar_motion import PlanarStep

NO_POSITION = 1


def two_tap(
    turn: Annotated[
        str | None, typer.Option("--turn", help="theta, to the left: 12deg, 12° or 0.21rad")
    ] = None,
    advance: Annotated[str | None, typer.Option("--advance", help="d: 20cm or 0.2m")] = None,
    focal: Annotated[str | None, typer.Option("--focal", help="1170px, or 24.03cm with --alpha")] = None,
    second: Annotated[
        str | None, typer.Option("--second", help="second tap, x or x,y [px] from the middle, y up")
    ] = None,
    first: Annotated[str, typer.Option("--first", help="first tap, likewise; x is 0 when centred")] = "0,0",
    alpha: Annotated[float | None, typer.Option("--alpha", help="pixels per cm, for a focal in cm")] = None,
    table: Annotated[
        int | None, typer.Option("--table", min=1, max=2, help="print the paper's table 1 or 2 anew")
    ] = None,
) -> None:
    """Find a target from two taps, a turn to the left and an advance between them (Chao et al. 2016).

    Exit code 0 with a position, 1 where the taps give none, 2 for numbers that cannot be read.
    """
    if table is not None:
        _print_table(table)
        return
    given = {"--turn": turn, "--advance": advance, "--focal": focal, "--second": second}
    missing = [name for name, value in given.items() if value is None]
    if turn is None or advance is None or focal is None or second is None:
        raise InputError(f"missing {', '.join(missing)}; see tapreach two-tap --help, or try --table 2")
    estimate = estimate_two_tap(
        ScreenOffset(*read_tap("--first", first)),
        ScreenOffset(*read_tap("--second", second)),
        read_focal_px(focal, alpha),
        PlanarStep(read_angle("--turn", turn), read_length("--advance", advance)),
    )
    _print_estimate(estimate)
    if estimate.position is None:
        raise typer.Exit(NO_POSITION)


def _print_estimate(estimate: TwoTapEstimate) -> None:
    beta, phi = math.degrees(estimate.beta), math.degrees(estimate.phi)
    typer.echo(f"beta {beta:.2f}°, phi {phi:.2f}°")
    if estimate.position is None:
        typer.echo(f"no position ({estimate.status}): {estimate.reason}")
        return
    position = estimate.position
    typer.echo(f"distance OQ1: {100 * position.distance:.2f} cm")
    typer.echo(f"from O, the first tap (eq. 7):       {_in_cm(position.in_first)}")
    typer.echo(f"from O_NEW, the second tap (eq. 10): {_in_cm(position.in_second)}")
    typer.echo(f"height check (eq. 11): {_height_check(position)}")
    typer.echo(f"one pixel of the second tap moves OQ1 by {abs(100 * position.distance_per_unit):.2f} cm")


def _in_cm(point: FloatArray) -> str:
    x, y, z = (100.0 * float(value) for value in point)
    return f"X {x:.2f} cm right, Y {y:.2f} cm up, Z {z:.2f} cm ahead"


def _height_check(position: TwoTapPosition) -> str:
    return (
        f"{100 * position.in_first[1]:.2f} cm and {100 * position.in_second[1]:.2f} cm, "
        f"apart by {abs(100 * position.height_difference):.2f} cm (0 when both taps name one thing)"
    )


def _print_table(number: int) -> None:
    console = Console(highlight=False, width=100)
    if number == 1:
        _print_focal_table(console)
    else:
        _print_distance_table(console)


def _print_focal_table(console: Console) -> None:
    table = Table(title="Table 1: focal length, alpha 48.7 px/cm, Q_X 36 cm")
    for heading in ("P_Xp [px]", "P_X [cm]", "Q_Z [cm]", "f [cm]", "published", "deviation"):
        table.add_column(heading, justify="right")
    for row in TABLE_1:
        deviation = round(row.focal_cm, 2) - row.published_focal_cm
        cells = (row.offset_px, row.offset_cm, row.depth_cm)
        table.add_row(
            *(f"{cell:g}" for cell in cells),
            f"{row.focal_cm:.2f}",
            f"{row.published_focal_cm:.2f}",
            f"{deviation:+.2f}" if abs(deviation) >= 0.005 else "none",
        )
    console.print(table)
    computed = sum(row.focal_cm for row in TABLE_1) / len(TABLE_1)
    published = sum(row.published_focal_cm for row in TABLE_1) / len(TABLE_1)
    last = TABLE_1[-1]
    console.print(
        f"Mean f: {computed:.2f} cm from the rows' inputs, {published:.2f} cm from the printed column. "
        f"The last row gives {last.focal_cm:.2f} from its own inputs, not the printed "
        f"{last.published_focal_cm:.2f}."
    )


def _print_distance_table(console: Console) -> None:
    table = Table(title="Table 2: distance OQ1, theta 12°, d 20 cm, f 24.03 cm")
    for heading in (
        "P_N(Xp)",
        "w [cm]",
        "beta [°]",
        "phi [°]",
        "true",
        "OQ1 [cm]",
        "published",
        "w unrounded",
    ):
        table.add_column(heading, justify="right")
    for row in TABLE_2:
        table.add_row(
            f"{row.offset_px:g}",
            f"{row.offset_cm:.2f}",
            f"{row.beta_deg:.2f}",
            f"{row.phi_deg:.2f}",
            f"{row.true_cm:g}",
            f"{row.distance_cm:.2f}",
            f"{row.published_cm:.2f}",
            f"{row.distance_unrounded_cm:.2f}",
        )
    console.print(table)
    far = TABLE_2[-1]
    console.print(
        f"With w rounded to two decimals, as the paper prints it, both rows come out exactly. Unrounded, the "
        f"far row is {far.distance_unrounded_cm:.2f} cm instead of {far.published_cm:.2f}: rounding w by "
        f"0.004 cm moves it by {far.distance_cm - far.distance_unrounded_cm:.1f} cm, about as much as "
        "one pixel does."
    )
