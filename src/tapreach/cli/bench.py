"""`tapreach bench`: measure, and write the page that shows the last full runs."""

import asyncio
import secrets
from collections.abc import Callable, Coroutine
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console

from tapreach.bench import accuracy as accuracy_bench
from tapreach.bench import control as control_bench
from tapreach.bench import fetch as fetch_bench
from tapreach.bench import fetch_plan, locate_plan, tracking_plan
from tapreach.bench import firmware as firmware_bench
from tapreach.bench import footprint as footprint_bench
from tapreach.bench import locate as locate_bench
from tapreach.bench import online_path as online_bench
from tapreach.bench import tracking as tracking_bench
from tapreach.bench import video as video_bench
from tapreach.bench.accuracy_plan import AccuracyPlan, Chapter, smoke_plan
from tapreach.bench.document import benchmarks_document
from tapreach.bench.report import Report, Section, write_report
from tapreach.bench.table import grid_table, print_closing, section_table
from tapreach.robot.clock import MonotonicClock

bench = typer.Typer(
    name="bench", help="Measure on this machine, over loopback, with its own load.", no_args_is_help=True
)

Smoke = Annotated[bool, typer.Option("--smoke", help="a few seconds: shows that the bench works")]
Json = Annotated[
    Path | None, typer.Option("--json", help="where the result goes [default: out/bench/NAME.json]")
]
Seed = Annotated[int, typer.Option(help="of all that is random")]
FreshSeed = Annotated[
    int | None, typer.Option("--seed", min=0, help="of all that is random [default: a fresh one]")
]
Seconds = Annotated[float, typer.Option(min=1.0, help="for each measurement")]


@bench.command()
def video(smoke: Smoke = False, seconds: Seconds = 20.0, seed: Seed = 1, json: Json = None) -> None:
    """Age of the pictures at viewers and on the page, slow links, taps, the simulator. About 5 minutes."""
    plan = video_bench.smoke_plan() if smoke else video_bench.VideoPlan(seconds=seconds, seed=seed)
    _run(lambda on_section: video_bench.run_video(plan, on_section, MonotonicClock()), json)


@bench.command()
def control(
    smoke: Smoke = False,
    seconds: Seconds = 60.0,
    hold: Annotated[float, typer.Option(min=1.0, help="seconds that the drive key is held")] = 610.0,
    seed: Seed = 1,
    json: Json = None,
) -> None:
    """Command round trip while estimating, times to stop, false stops, processes left. About 15 minutes."""
    plan = control_bench.ControlPlan(seconds=seconds, hold_seconds=hold, seed=seed)
    if smoke:
        plan = control_bench.smoke_plan()
    _run(lambda on_section: control_bench.run_control(plan, on_section, MonotonicClock()), json)


@bench.command()
def accuracy(
    smoke: Smoke = False,
    trials: Annotated[int, typer.Option(min=2, help="in each of 48 settings, more where needed")] = 250,
    motions: Annotated[int, typer.Option(min=30, help="random ones, a fifth of them singular")] = 100_000,
    comparisons: Annotated[int, typer.Option(min=1, help="trials in each setting beside the peers")] = 100,
    part: Annotated[Chapter | None, typer.Option(help="run this one alone")] = None,
    jobs: Annotated[int, typer.Option(min=1, help="processes, but for what is timed")] = 1,
    seed: FreshSeed = None,
    plot: Annotated[Path | None, typer.Option(help="picture of every setting; needs matplotlib")] = None,
    json: Json = None,
) -> None:
    """The estimator in simulation against its bound, its own regions, other libraries and the best move.

    A long run; each chapter alone by --part. The seed makes a run again.
    """
    used = _told(seed)
    plan = AccuracyPlan(used, trials, motions, comparisons, jobs=jobs, plot=plot, chapter=part)
    if smoke:
        plan = smoke_plan(used, part)
    _run(lambda on_section: accuracy_bench.run_accuracy(plan, on_section, MonotonicClock()), json)


@bench.command()
def locate(
    smoke: Smoke = False,
    taps: Annotated[int, typer.Option(min=1, help="random ones, over all scenes")] = 200,
    comparisons: Annotated[int, typer.Option(min=1, help="so many of them also in other ways")] = 60,
    jobs: Annotated[int, typer.Option(min=1, help="processes")] = 1,
    minutes: Annotated[float, typer.Option(min=0.1, help="no tap is begun later than this")] = 90.0,
    keep: Annotated[Path | None, typer.Option(help="file of finished taps; goes on where it ends")] = None,
    seed: FreshSeed = None,
    plot: Annotated[Path | None, typer.Option(help="picture of every tap; needs matplotlib")] = None,
    failures: Annotated[Path | None, typer.Option(help="picture of the taps that went wrong (.jpg)")] = None,
    json: Json = None,
) -> None:
    """One tap to a position in the rendered simulator, robot and all, against the truth. An hour and more."""
    used = _told(seed)
    plan = locate_plan.LocatePlan(
        used, taps, comparisons, jobs=jobs, minutes=minutes, kept=keep, plot=plot, failures=failures
    )
    if smoke:
        plan = locate_plan.smoke_plan(used)
    _run(lambda on_section: locate_bench.run_locate(plan, on_section, MonotonicClock()), json)


@bench.command()
def fetch(
    smoke: Smoke = False,
    scenes: Annotated[int, typer.Option(min=1, help="random rooms at each level of faults")] = 100,
    refusals: Annotated[int, typer.Option(min=1, help="things that cannot be grasped")] = 60,
    stops: Annotated[int, typer.Option(min=1, help="fetches that the operator stops")] = 200,
    clutter: Annotated[int, typer.Option(min=1, help="fetches in cluttered rooms")] = 60,
    comparisons: Annotated[int, typer.Option(min=0, help="so many rooms also in other ways")] = 40,
    part: Annotated[fetch_plan.Chapter | None, typer.Option(help="run this one alone")] = None,
    jobs: Annotated[int, typer.Option(min=1, help="processes")] = 1,
    minutes: Annotated[float, typer.Option(min=0.1, help="no run is begun later than this")] = 600.0,
    keep: Annotated[Path | None, typer.Option(help="file of finished runs; goes on where it ends")] = None,
    seed: FreshSeed = None,
    failures: Annotated[Path | None, typer.Option(help="picture of the runs that went wrong (.jpg)")] = None,
    json: Json = None,
) -> None:
    """One tap to the thing in the claw in the rendered simulator, against the truth. Many hours.

    Each chapter alone by --part. The seed makes a run again.
    """
    used = _told(seed)
    plan = fetch_plan.FetchBenchPlan(
        used,
        scenes,
        refusals,
        stops,
        clutter,
        comparisons,
        jobs=jobs,
        minutes=minutes,
        chapter=part,
        kept=keep,
        failures=failures,
    )
    if smoke:
        plan = fetch_plan.smoke_plan(used, part, keep, failures)
    _run(lambda on_section: fetch_bench.run_fetch_bench(plan, on_section, MonotonicClock()), json)


@bench.command()
def tracking(
    smoke: Smoke = False,
    taps: Annotated[int, typer.Option(min=1, help="tapped points of each film")] = 12,
    random_scenes: Annotated[int, typer.Option(min=0, help="beside those that ship")] = 7,
    jobs: Annotated[int, typer.Option(min=1, help="processes that draw")] = 1,
    seed: FreshSeed = None,
    json: Json = None,
) -> None:
    """Tapped points followed through rendered films, against the truth and OpenCV. Many minutes."""
    used = _told(seed)
    plan = tracking_plan.full_plan(used, random_scenes, taps, jobs)
    if smoke:
        plan = tracking_plan.smoke_plan(used)
    _run(lambda on_section: tracking_bench.run_tracking(plan, on_section, MonotonicClock()), json)


@bench.command()
def online(
    smoke: Smoke = False,
    taps: Annotated[int, typer.Option(min=1, help="random ones, over all scenes")] = 12,
    seed: FreshSeed = None,
    json: Json = None,
) -> None:
    """What each picture costs while locating, step by step, on one core. A few minutes."""
    used = _told(seed)
    plan = online_bench.OnlinePlan(used, 1 if smoke else taps, smoke)
    _run(lambda on_section: online_bench.run_online(plan, on_section, MonotonicClock()), json)


@bench.command()
def firmware(
    smoke: Smoke = False,
    board: Annotated[str, typer.Option(help="uno or mega")] = "uno",
    vanishings: Annotated[int, typer.Option(min=5, help="moments at which the host vanishes")] = 200,
    moves: Annotated[int, typer.Option(min=2, help="random turns and advances")] = 100,
    noise_bytes: Annotated[int, typer.Option(min=1000, help="random and damaged ones")] = 1_000_000,
    hours: Annotated[float, typer.Option(min=0.0, help="of simulated time at work")] = 24.0,
    wraps: Annotated[int, typer.Option(min=3, help="starts shortly before the clocks wrap")] = 30,
    seed: FreshSeed = None,
    json: Json = None,
) -> None:
    """The compiled firmware in a simulated microcontroller in a simulated robot. Takes 1.5 hours."""
    used = _told(seed)
    plan = firmware_bench.FirmwarePlan(used, board, 300, vanishings, moves, noise_bytes, hours, wraps)
    if smoke:
        plan = firmware_bench.smoke_plan(used, board)
    _run(lambda on_section: firmware_bench.run_firmware(plan, on_section, MonotonicClock()), json)


@bench.command("run")
def run_command(
    smoke: Smoke = False,
    robot: Annotated[str, typer.Option(help="a shipped robot or the path of a robot file")] = "sim",
    seconds: Seconds = 20.0,
    json: Json = None,
) -> None:
    """Memory and processor that `tapreach run` takes on this machine, with and without a viewer. A minute."""
    plan = footprint_bench.FootprintPlan(robot, 1.0 if smoke else seconds, smoke)
    _run(lambda on_section: footprint_bench.run_footprint(plan, on_section, MonotonicClock()), json)


@bench.command()
def document(docs: Annotated[Path, typer.Option(help="folder of the documents")] = Path("docs")) -> None:
    """Write benchmarks.md in the folder of the documents from the JSON in its folder benchmarks."""
    page = docs / "benchmarks.md"
    page.write_text(benchmarks_document(docs / "benchmarks"), encoding="utf-8")
    Console().print(f"wrote {page}", highlight=False)


def _told(seed: int | None) -> int:
    """Return the seed given or a fresh one, and print it: it makes the run again."""
    used = secrets.randbits(32) if seed is None else seed
    Console().print(f"seed {used}", highlight=False)
    return used


def _run(
    measure: Callable[[Callable[[Section], None]], Coroutine[Any, Any, Report]], json: Path | None
) -> None:
    console = Console()

    def show(section: Section) -> None:
        console.print(section_table(section))
        if section.grid is not None:
            console.print(grid_table(section.grid))

    report = asyncio.run(measure(show))
    print_closing(report, console)
    path = json or Path("out") / "bench" / f"{report.bench.replace(' --part ', '-')}.json"
    write_report(report, path)
    console.print(f"wrote {path}", highlight=False)
