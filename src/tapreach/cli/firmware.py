"""`tapreach firmware`: build what runs on the robot's board, say what it takes, and flash it."""

import shutil
import subprocess
from enum import StrEnum
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table

from tapreach.drivers.arduino.boards import BOARDS, Board, board_named
from tapreach.drivers.arduino.build import Built, build, hex_file
from tapreach.errors import DriverError, SetupError

TOO_LARGE = 1
FLASH_BOUND_S = 180

firmware = typer.Typer(
    name="firmware", help="Build the firmware of the robot's board, and flash it.", no_args_is_help=True
)


class BoardName(StrEnum):
    """Boards by the names of BOARDS."""

    UNO = "uno"
    MEGA = "mega"
    LEONARDO = "leonardo"
    PRO_MICRO = "promicro"
    YUN = "yun"


class DriveKind(StrEnum):
    """What turns the wheels."""

    DC = "dc"
    STEPPER = "stepper"


OneBoard = Annotated[BoardName, typer.Option("--board", help="what it is built for")]
Drive = Annotated[DriveKind, typer.Option("--drive", help="motors with encoders, or steppers")]
Definitions = Annotated[
    list[str] | None, typer.Option("-D", help="NAME or NAME=VALUE, such as MOTOR_TB6612 or ENCODER_SINGLE")
]


@firmware.command("build")
def build_command(
    board: OneBoard,
    drive: Drive = DriveKind.DC,
    define: Definitions = None,
    out: Annotated[
        Path | None, typer.Option("--out", help="the ELF [default: out/firmware/BOARD.elf]")
    ] = None,
) -> None:
    """Compile the firmware for a board."""
    console = Console(highlight=False)
    built = _build(board_named(board.value), out, _with_drive(define, drive))
    console.print(_sentence(built), soft_wrap=True)
    console.print(f"{built.elf} and {hex_file(built).name}", soft_wrap=True)
    raise typer.Exit(0 if built.is_within_limits else TOO_LARGE)


@firmware.command()
def check(drive: Drive = DriveKind.DC, define: Definitions = None) -> None:
    """Compile for every board and say what it takes; exit code 1 where one is over its limit."""
    names = _with_drive(define, drive)
    table = Table("board", "flash", "of", "RAM", "of", "fits")
    with TemporaryDirectory() as folder:
        all_built = [build(board, Path(folder) / f"{board.name}.elf", names) for board in BOARDS.values()]
    for each in all_built:
        sizes = (each.flash, each.board.flash, each.ram, each.board.ram)
        table.add_row(each.board.title, *map(str, sizes), "yes" if each.is_within_limits else "no")
    Console(highlight=False).print(table)
    raise typer.Exit(0 if all(each.is_within_limits for each in all_built) else TOO_LARGE)


@firmware.command()
def flash(
    board: OneBoard,
    port: Annotated[str, typer.Option("--port", help="serial port of the board, such as /dev/ttyACM0")],
    drive: Drive = DriveKind.DC,
    define: Definitions = None,
) -> None:
    """Compile the firmware and write it to a board by avrdude."""
    console = Console(highlight=False)
    chosen = board_named(board.value)
    programmer = _programmer()
    built = _build(chosen, None, _with_drive(define, drive))
    if not built.is_within_limits:
        console.print(_sentence(built), soft_wrap=True)
        raise typer.Exit(TOO_LARGE)
    words = ["-p", chosen.mcu, "-c", chosen.programmer, "-P", port, "-b", str(chosen.baud), "-D"]
    _write(programmer, [*words, "-U", f"flash:w:{hex_file(built)}:i"], port)
    console.print(f"{_sentence(built)} It is on the board at {port}.", soft_wrap=True)


def _with_drive(define: list[str] | None, drive: DriveKind) -> list[str]:
    return [*(define or ()), *(["TAPREACH_STEPPER"] if drive is DriveKind.STEPPER else [])]


def _build(board: Board, out: Path | None, define: list[str]) -> Built:
    return build(board, out or Path("out") / "firmware" / f"{board.name}.elf", define)


def _sentence(built: Built) -> str:
    board, fits = built.board, "fits" if built.is_within_limits else "is too large"
    return (
        f"Firmware for {board.title} {fits}: flash {built.flash} of {board.flash} bytes, "
        f"RAM {built.ram} of {board.ram} (a quarter is for the stack)."
    )


def _programmer() -> str:
    found = shutil.which("avrdude")
    if found is None:
        raise SetupError("cannot flash: avrdude not found; install it with: apt-get install avrdude")
    return found


def _write(programmer: str, words: list[str], port: str) -> None:
    if not Path(port).exists():
        raise DriverError(f"there is no serial port {port!r}; plug the board in, or name another by --port")
    try:
        done = subprocess.run([programmer, *words], capture_output=True, text=True, timeout=FLASH_BOUND_S)
    except subprocess.TimeoutExpired:
        raise DriverError(
            f"avrdude did not end within {FLASH_BOUND_S} s; reset the board, try again"
        ) from None
    if done.returncode != 0:
        raise DriverError(f"avrdude could not write to {port}:\n{done.stderr.strip()}")
