"""`tapreach doctor`: look at everything a robot needs, and say what to do about what is not well."""

import asyncio
import json
from collections.abc import Coroutine
from dataclasses import asdict
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any, NoReturn

import typer
from rich.console import Console

from tapreach.cli.checkup.check import Check, Verdict, worst
from tapreach.cli.checkup.examine import examine
from tapreach.cli.robot_file import find_robot_file
from tapreach.cli.teaching.person import Terminal
from tapreach.cli.teaching.teach import teach
from tapreach.errors import InputError
from tapreach.robot.clock import MonotonicClock
from tapreach.robot.config import load_robot
from tapreach.tasks.teaching.lesson import Lesson
from tapreach.tasks.teaching.person import TeachingStopped

NOT_WELL = 1
COLOURS = {Verdict.OK: "green", Verdict.WARN: "yellow", Verdict.FAIL: "bold red"}
CLOSING = {
    Verdict.OK: "All is well.",
    Verdict.WARN: "It can be used; better after what is said above.",
    Verdict.FAIL: "Mend the first thing that fails, then look again: it may explain the others.",
}


class Measure(StrEnum):
    """What the robot measures by itself."""

    DELAY = "delay"


def doctor(
    robot: Annotated[str, typer.Option(help="a shipped robot or the path of a robot file")],
    as_json: Annotated[bool, typer.Option("--json", help="for programs")] = False,
    captures: Annotated[Path, typer.Option(help="where stored pictures go")] = Path("captures"),
    lesson: Annotated[
        Lesson | None, typer.Option("--teach", help="instead: small moves, step by step, as you say")
    ] = None,
    measure: Annotated[
        Measure | None, typer.Option("--measure", help="instead: how late the camera is; the robot turns")
    ] = None,
) -> None:
    """Check camera, link, firmware, battery, servos, Wi-Fi and disk; nothing of the robot moves.

    With --teach it asks and moves, wheels off the ground: servo limits and directions, which way motors turn
    and encoders count, ticks of a turn. With --measure delay the robot turns to and fro on the floor and
    watches. What came of it goes into the robot file, comments untouched.

    Exit code 0 when nothing fails (warnings allowed), 1 when something does, 2 for what cannot be used.
    """
    if lesson is not None and measure is not None:
        raise InputError("--teach and --measure are two things: one after the other")
    if lesson is not None:
        _hold(teach(lesson, find_robot_file(robot), Terminal(), MonotonicClock()))
    if measure is not None:
        # Loaded where it is needed only: it brings the whole server.
        from tapreach.cli.teaching.delay import measure_delay

        _hold(measure_delay(find_robot_file(robot), Terminal("--measure"), MonotonicClock()))
    description = load_robot(find_robot_file(robot))
    checks = asyncio.run(examine(description, MonotonicClock(), captures))
    if as_json:
        typer.echo(as_document(description.name, checks))
    else:
        _show(description.name, checks)
    raise typer.Exit(NOT_WELL if worst(checks) is Verdict.FAIL else 0)


def _hold(lesson: Coroutine[Any, Any, bool]) -> NoReturn:
    try:
        is_right = asyncio.run(lesson)
    except TeachingStopped as stopped:
        typer.echo(stopped, err=True)
        raise typer.Exit(NOT_WELL) from None
    raise typer.Exit(0 if is_right else NOT_WELL)


def as_document(name: str, checks: list[Check]) -> str:
    """Return the checks as JSON."""
    told = [asdict(check) for check in checks]
    return json.dumps({"robot": name, "verdict": worst(checks), "checks": told}, indent=2, ensure_ascii=False)


def _show(name: str, checks: list[Check]) -> None:
    console = Console(highlight=False)
    console.print(f"Robot {name!r}", markup=False)
    for check in checks:
        console.print(f"  {check.verdict:5}", end="", style=COLOURS[check.verdict])
        console.print(f"{check.name:9} {check.found}", markup=False, soft_wrap=True)
        if check.advice:
            console.print(f"{'':17}{check.advice}", markup=False, soft_wrap=True)
    console.print(CLOSING[worst(checks)])
