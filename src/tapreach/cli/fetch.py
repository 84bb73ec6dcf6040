"""`tapreach fetch`: fetch what is at a pixel of a frame, for whoever has a detector of their own."""

from enum import StrEnum
from typing import Annotated

import typer
from rich.console import Console

from tapreach.cli.quantity import read_pixels
from tapreach.client.address import LOCAL
from tapreach.client.control_link import RequestRefused
from tapreach.client.fetching import FetchResult, FetchStatus
from tapreach.client.news import FetchNews
from tapreach.client.sync import SyncRobot, connect
from tapreach.errors import InputError, LinkLost
from tapreach.geometry.pixel_box import PixelBox

NOT_FETCHED = 1


class FetchMode(StrEnum):
    """How far it goes by itself."""

    PLAN = "plan"
    CONFIRM = "confirm"
    GO = "go"


def fetch(
    at: Annotated[
        str | None, typer.Option("--at", help="U,V of the thing [px], 0,0 in the middle of the top-left one")
    ] = None,
    frame: Annotated[
        int | None, typer.Option("--frame", min=1, help="frame id that U,V belong to [default: the newest]")
    ] = None,
    mode: Annotated[FetchMode, typer.Option(help="say how, ask before doing it, or do it")] = FetchMode.GO,
    box: Annotated[
        str | None, typer.Option("--box", help="LEFT,TOP,RIGHT,BOTTOM around the thing [px]: its size")
    ] = None,
    url: Annotated[
        str, typer.Option(envvar="TAPREACH_URL", help="what tapreach run printed, with its token")
    ] = LOCAL,
) -> None:
    """Let the robot of a running `tapreach run` fetch what is at a pixel; Ctrl-C stops it.

    Exit code 0 when it is held (with --mode plan: can be fetched), 1 when not, with the reason on stderr,
    2 for what cannot be used.
    """
    (u, v), around = _place(at, box)
    try:
        with connect(url, name="tapreach fetch") as robot:
            result = _fetched(robot, frame, u, v, mode, around)
    except (RequestRefused, LinkLost) as error:
        _say_on_stderr(f"not fetched: {error}")
        raise typer.Exit(NOT_FETCHED) from error
    except KeyboardInterrupt:
        _say_on_stderr("stopped: the robot stands")
        raise
    _conclude(result)


def _place(at: str | None, box: str | None) -> tuple[tuple[float, float], PixelBox | None]:
    around = PixelBox(*read_pixels("--box", box, "300,200,360,290")) if box is not None else None
    if at is not None:
        u, v = read_pixels("--at", at, "320,240")
        return (u, v), around
    if around is None:
        raise InputError("nothing to fetch; give --at U,V or --box LEFT,TOP,RIGHT,BOTTOM in pixels")
    return (around.middle.u, around.middle.v), around


def _fetched(
    robot: SyncRobot, frame: int | None, u: float, v: float, mode: FetchMode, box: PixelBox | None
) -> FetchResult:
    frame_id = robot.snapshot().frame_id if frame is None else frame
    return robot.fetch(frame_id, u, v, mode=mode.value, box=box, on_phase=_show, agrees=_agrees)


def _show(phase: FetchNews) -> None:
    if not phase.is_final:
        _print_line(phase.phase or "", phase.does + (f" ({phase.why})" if phase.why else ""))


def _agrees(plan: FetchNews) -> bool:
    seconds = f", about {plan.seconds:.0f} s" if plan.seconds is not None else ""
    return typer.confirm(f"{plan.reason or 'it can be fetched'}{seconds}: fetch it?")


def _conclude(result: FetchResult) -> None:
    last = result.last
    if result.status is FetchStatus.HELD:
        _print_line(result.status, result.reason)
    elif result.status is FetchStatus.PLANNED:
        _print_line(result.status, f"can it be fetched: {last.verdict if last else ''}; {result.reason}")
    else:
        condition = f"; {last.condition}" if last is not None and last.condition else ""
        _say_on_stderr(f"{result.status}: {result.reason}{condition}")
        raise typer.Exit(NOT_FETCHED)


def _print_line(head: str, text: str) -> None:
    Console(highlight=False).print(f"{head:<10} {text}", markup=False, soft_wrap=True)


def _say_on_stderr(text: str) -> None:
    Console(stderr=True, highlight=False).print(f"tapreach: {text}", markup=False, soft_wrap=True)
