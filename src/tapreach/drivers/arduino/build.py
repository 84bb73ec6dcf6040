"""Building the firmware with the toolchain of Debian's packages: no IDE, no network."""

import re
import shutil
import subprocess
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from tapreach.drivers.arduino.boards import Board
from tapreach.errors import InputError, SetupError
from tapreach.resources import resource_path

CORE = Path("/usr/share/arduino/hardware/arduino/avr")
PACKAGES = ("gcc-avr", "avr-libc", "arduino-core-avr")
BUILD_BOUND_S = 120

_SHARED = (
    *("-DF_CPU=16000000L", "-DARDUINO=10819", "-DARDUINO_ARCH_AVR", "-Os", "-g"),
    *("-ffunction-sections", "-fdata-sections", "-flto", "-fno-fat-lto-objects"),
)
_BUFFERS = ("-DSERIAL_RX_BUFFER_SIZE=128", "-DSERIAL_TX_BUFFER_SIZE=128")
# float.h of avr-gcc 5.4 hides DECIMAL_DIG from C++, and the core needs it.
_CPP = (
    *("-std=gnu++11", "-fpermissive", "-fno-exceptions", "-fno-threadsafe-statics"),
    "-DDECIMAL_DIG=__DECIMAL_DIG__",
)
_OURS = ("-Wall", "-Wextra")
_DEFINITION = re.compile(r"[A-Za-z_]\w*(=\w*)?")


@dataclass(frozen=True)
class Built:
    """A built firmware and what it takes of its board [bytes]."""

    board: Board
    elf: Path
    flash: int
    ram: int

    @property
    def is_within_limits(self) -> bool:
        """Whether it fits, with a quarter of the RAM left to the stack."""
        return self.flash <= self.board.flash and self.ram <= self.board.ram * 3 // 4


def missing_tools(core: Path = CORE) -> list[str]:
    """Return what is missing on this machine to build; empty where nothing is."""
    missing = [name for name in ("avr-gcc", "avr-g++", "avr-size") if shutil.which(name) is None]
    return missing + ([] if core.is_dir() else [str(core)])


def build(board: Board, elf: Path, definitions: Iterable[str] = (), core: Path = CORE) -> Built:
    """Compile the firmware for a board into `elf`; `definitions` are NAME or NAME=VALUE.

    Raises SetupError where the toolchain is missing or the compiler refuses, InputError for a definition that
    cannot be one.
    """
    if missing := missing_tools(core):
        raise SetupError(
            f"cannot build firmware: {', '.join(missing)} not found; "
            f"install it with: apt-get install {' '.join(PACKAGES)}"
        )
    extra = [_definition(each) for each in definitions]
    elf.parent.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory() as folder:
        objects = [
            _compile(source, Path(folder) / f"{index}.o", board, core, extra)
            for index, source in enumerate(_sources(core))
        ]
        words = ["-w", "-Os", "-g", "-flto", "-fuse-linker-plugin", "-Wl,--gc-sections", f"-mmcu={board.mcu}"]
        _run(["avr-gcc", *words, "-o", str(elf), *objects, "-lm"])
    return measured(board, elf)


def measured(board: Board, elf: Path) -> Built:
    """Return what a built firmware takes: code and initial values in flash, all variables in RAM."""
    text, data, bss = (int(word) for word in _run(["avr-size", str(elf)]).splitlines()[1].split()[:3])
    return Built(board, elf, text + data, data + bss)


def hex_file(built: Built) -> Path:
    """Write the image that is flashed beside the ELF, and return its path."""
    image = built.elf.with_suffix(".hex")
    _run(["avr-objcopy", "-O", "ihex", "-R", ".eeprom", str(built.elf), str(image)])
    return image


def _definition(text: str) -> str:
    if not _DEFINITION.fullmatch(text):
        raise InputError(f"{text!r} is no definition; say NAME or NAME=VALUE, as ENCODER_SINGLE")
    return f"-D{text}"


def _sources(core: Path) -> Iterator[Path]:
    yield resource_path("firmware") / "tapreach" / "tapreach.ino"
    yield from sorted(p for p in (core / "cores/arduino").iterdir() if p.suffix in {".c", ".cpp", ".S"})


def _compile(source: Path, target: Path, board: Board, core: Path, extra: list[str]) -> str:
    variant = core / "variants" / board.variant
    if not (variant / "pins_arduino.h").exists():
        raise SetupError(
            f"the Arduino core in {core} has no variant {board.variant!r}; install arduino-core-avr"
        )
    words = [*_compiler(source), f"-mmcu={board.mcu}", *_SHARED, *_usb_or_uart(board), *extra]
    words += [f"-DARDUINO_{board.define}", f"-I{core / 'cores/arduino'}", f"-I{variant}"]
    _run([*words, "-c", str(source), "-o", str(target)])
    return str(target)


def _compiler(source: Path) -> list[str]:
    match source.suffix:
        case ".ino":
            return ["avr-g++", *_CPP, *_OURS, "-x", "c++"]
        case ".cpp":
            return ["avr-g++", *_CPP, "-w"]
        case ".c":
            return ["avr-gcc", "-std=gnu11", "-w"]
        case _:
            return ["avr-gcc", "-x", "assembler-with-cpp"]


def _usb_or_uart(board: Board) -> tuple[str, ...]:
    if board.usb_ids is None:
        return _BUFFERS
    vendor, product = board.usb_ids
    return (f"-DUSB_VID={vendor:#x}", f"-DUSB_PID={product:#x}", *_BUFFERS)


def _run(words: list[str]) -> str:
    try:
        done = subprocess.run(words, capture_output=True, text=True, timeout=BUILD_BOUND_S)
    except subprocess.TimeoutExpired:
        raise SetupError(f"{words[0]} did not end within {BUILD_BOUND_S} s") from None
    if done.returncode != 0:
        raise SetupError(f"{words[0]} failed:\n{done.stderr.strip()}")
    return done.stdout
