"""Boards that the firmware is built for: microcontroller, its limits, and how it is flashed."""

from dataclasses import dataclass

from tapreach.errors import InputError


@dataclass(frozen=True)
class Board:
    """One board. Flash without its boot loader, and RAM [bytes], as the Arduino core states them."""

    name: str
    title: str
    mcu: str
    variant: str
    define: str
    flash: int
    ram: int
    programmer: str
    baud: int
    usb_ids: tuple[int, int] | None = None


def _usb_board(name: str, title: str, define: str) -> Board:
    """Return an ATmega32U4 that its USB connects to the host."""
    return Board(
        name, title, "atmega32u4", "leonardo", define, 28672, 2560, "avr109", 57600, (0x2341, 0x8036)
    )


BOARDS = {
    board.name: board
    for board in (
        Board("uno", "Uno, Nano", "atmega328p", "standard", "AVR_UNO", 32256, 2048, "arduino", 115200),
        Board("mega", "Mega 2560", "atmega2560", "mega", "AVR_MEGA2560", 253952, 8192, "wiring", 115200),
        _usb_board("leonardo", "Leonardo", "AVR_LEONARDO"),
        _usb_board("promicro", "Pro Micro", "AVR_PROMICRO"),
        Board("yun", "Yún", "atmega32u4", "yun", "AVR_YUN", 28672, 2560, "avr109", 57600, (0x2341, 0x8041)),
    )
}


def board_named(name: str) -> Board:
    """Return a board. Raises InputError that lists the known ones."""
    if name not in BOARDS:
        raise InputError(f"there is no board {name!r}; known are {', '.join(sorted(BOARDS))}")
    return BOARDS[name]
