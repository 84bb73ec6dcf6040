"""What firmware/tapreach/pins.h says of each board, read as text, and what each pin is wired to."""

import re
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PINS = ROOT / "firmware" / "tapreach" / "pins.h"
_CONSTANT = re.compile(r"(\w+)(?:\[\d\])? = (\{[^}]*\}|[\w:]+)[,;]")
SIDES = ("left", "right")
JOINTS = ("A rotation", "B shoulder", "C elbow", "D claw")


@dataclass(frozen=True)
class BoardPage:
    """A board as the page shows it; `macro` opens its branch in pins.h."""

    name: str
    title: str
    macro: str
    note: str


BOARDS = (
    BoardPage(
        "uno", "Uno, Nano", "__AVR_ATmega328P__", "The host is on USB (pins 0 and 1 stay free of wires)."
    ),
    BoardPage(
        "mega", "Mega 2560", "__AVR_ATmega2560__", "The host is on USB (pins 0 and 1 stay free of wires)."
    ),
    BoardPage(
        "leonardo",
        "Leonardo, Yún",
        "__AVR_ATmega32U4__",
        "Leonardo: the host is on USB. Yún: the host is its own Linux side; pin 7 belongs to that too: tie "
        "STBY to 5 V there (ENABLE of step drivers to ground).",
    ),
    BoardPage(
        "promicro",
        "Pro Micro",
        "ARDUINO_AVR_PROMICRO",
        "The host is on USB. It has its own pins because 11 to 13, A4 and A5 lead nowhere on this board.",
    ),
)


@dataclass(frozen=True)
class Wire:
    """From a pin of the board to terminals of a part; '' where that part has none."""

    pin: str
    group: str
    meaning: str
    l298n: str = ""
    tb6612: str = ""
    stepper: str = ""
    terminal: str = ""

    @property
    def label(self) -> str:
        """What the drawing writes at the part's end."""
        return self.terminal or f"{self.l298n or '-'} / {self.tb6612}"


def pins_of(macro: str, text: str) -> dict[str, tuple[str, ...]]:
    """Return the constants of one board's branch of pins.h, each as a tuple of pins."""
    start = re.search(rf"^#(?:el)?if defined\({macro}\)", text, re.M)
    if start is None:
        raise SystemExit(f"{PINS} has no branch for {macro}")
    rest = text[start.end() :]
    branch = rest[: rest.index("#define ENCODER_PORT")]
    found = {name: tuple(re.findall(r"\w+", value)) for name, value in _CONSTANT.findall(branch)}
    return {name: pins for name, pins in found.items() if name not in {"BOARD", "A_BIT", "B_BIT"}}


def wires_of(pins: dict[str, tuple[str, ...]]) -> list[Wire]:
    """Return the wires of a board, grouped by the part they go to."""
    wires = []
    for side, (wheel, en, first, second) in enumerate(
        zip(SIDES, "AB", ("IN1", "IN3"), ("IN2", "IN4"), strict=True)
    ):
        wires += [
            Wire(pins["PWM"][side], "motors", f"speed {wheel}", f"EN{en}", f"PWM{en}", f"STEP {wheel}"),
            Wire(pins["FORWARD"][side], "motors", f"forward {wheel}", first, f"{en}IN1", f"DIR {wheel}"),
            Wire(pins["REVERSE"][side], "motors", f"back {wheel}", second, f"{en}IN2"),
        ]
    wires.append(Wire(pins["STANDBY"][0], "motors", "standby", "", "STBY", "ENABLE of both"))
    for side, wheel in enumerate(SIDES):
        wires += [
            Wire(pins["ENCODER_A"][side], "encoders", f"encoder {wheel}", terminal="A"),
            Wire(pins["ENCODER_B"][side], "encoders", f"encoder {wheel}", terminal="B"),
        ]
    wires += [
        Wire(pin, "servos", f"servo {joint}", terminal="signal")
        for pin, joint in zip(pins["SERVO"], JOINTS, strict=True)
    ]
    return [
        *wires,
        Wire(pins["STOP"][0], "safety", "stop button", terminal="to ground"),
        Wire(pins["BATTERY"][0], "safety", "battery voltage", terminal="middle of 20 k / 10 k"),
        Wire(pins["LED"][0], "safety", "status LED", terminal="on the board, or 1 k to an LED"),
    ]


def read_boards() -> list[tuple[BoardPage, list[Wire]]]:
    """Return every board with its wires."""
    text = PINS.read_text(encoding="utf-8")
    return [(board, wires_of(pins_of(board.macro, text))) for board in BOARDS]
