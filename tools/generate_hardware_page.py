"""Write the wiring of docs/hardware.md and its drawings from the pins that the firmware is built with.

    .venv/bin/python tools/generate_hardware_page.py

tests/tools/test_hardware_page.py fails while they are not current.
"""

import sys
from html import escape
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from hardware_pins import ROOT, BoardPage, Wire, read_boards
from hardware_power import power_drawing

PAGE = ROOT / "docs" / "hardware.md"
PICTURES = ROOT / "docs" / "pictures"
BEGIN, END = "<!-- generated: begin -->", "<!-- generated: end -->"
PARTS = {
    "motors": "H-bridge: L298N / TB6612 (logic supply 5 V, ground)",
    "encoders": "encoders (supply 5 V of the board, ground)",
    "servos": "servos (supply 5 V of their regulator, ground)",
    "safety": "safety and power",
}
COLOURS = {"motors": "#c0392b", "encoders": "#1f6fb2", "servos": "#b7791f", "safety": "#2f855a"}
ROW, GAP, TOP, WIDTH = 24, 34, 74, 760
BOARD_LEFT, BOARD_RIGHT, PART_LEFT, PART_RIGHT = 30, 210, 400, 730


def render_page(present: str) -> str:
    """Return the page with its generated part made anew."""
    head, rest = present.split(BEGIN)
    return (
        head
        + BEGIN
        + "\n\n"
        + "\n".join(map(_section, *zip(*read_boards(), strict=True)))
        + END
        + rest.split(END)[1]
    )


def render_pictures() -> dict[Path, str]:
    """Return every drawing by its path."""
    boards = {PICTURES / f"wiring-{board.name}.svg": _drawing(board, wires) for board, wires in read_boards()}
    return boards | {PICTURES / "wiring-power.svg": power_drawing()}


def _section(board: BoardPage, wires: list[Wire]) -> str:
    rows = "\n".join(_row(wire) for wire in wires)
    return f"""### {board.title}

![Wiring of {board.title}: each pin and where it goes](pictures/wiring-{board.name}.svg)

{board.note}

| pin | what | L298N | TB6612 | step driver |
|---|---|---|---|---|
{rows}
"""


def _row(wire: Wire) -> str:
    if wire.terminal:
        return f"| {wire.pin} | {wire.meaning} | {wire.terminal} | same | {_for_stepper(wire)} |"
    cells = (wire.l298n, wire.tb6612, wire.stepper)
    return f"| {wire.pin} | {wire.meaning} | {' | '.join(cell or 'free' for cell in cells)} |"


def _for_stepper(wire: Wire) -> str:
    return "free" if wire.group == "encoders" else "same"


def _drawing(board: BoardPage, wires: list[Wire]) -> str:
    rows, y, group = [], TOP, ""
    boxes: dict[str, list[int]] = {}
    for wire in wires:
        y += GAP if wire.group != group and group else 0
        group = wire.group
        boxes.setdefault(group, []).append(y)
        rows.append(_wire(wire, y))
        y += ROW
    parts = [_part(name, ys) for name, ys in boxes.items()]
    height = y + 20
    body = [*_board(board, height), *parts, *rows]
    words = "font-family='DejaVu Sans, Verdana, sans-serif' font-size='13'"
    head = f"<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {WIDTH} {height}' width='{WIDTH}' {words}>"
    return "\n".join([head, f"<rect width='{WIDTH}' height='{height}' fill='white'/>", *body, "</svg>", ""])


def _board(board: BoardPage, height: int) -> list[str]:
    box = f"x='{BOARD_LEFT}' y='20' width='{BOARD_RIGHT - BOARD_LEFT}' height='{height - 34}' rx='10'"
    return [
        f"<rect {box} fill='#e8f1f2' stroke='#35656b' stroke-width='2'/>",
        f"<text x='{BOARD_LEFT + 14}' y='46' font-size='17' font-weight='bold'>{escape(board.title)}</text>",
    ]


def _part(name: str, ys: list[int]) -> str:
    top, bottom = ys[0] - 15, ys[-1] + 14
    box = f"x='{PART_LEFT}' y='{top}' width='{PART_RIGHT - PART_LEFT}' height='{bottom - top}' rx='6'"
    return (
        f"<rect {box} fill='#fafafa' stroke='{COLOURS[name]}' stroke-width='1.5'/>"
        f"<text x='{PART_RIGHT}' y='{top - 5}' text-anchor='end' font-size='12' "
        f"font-weight='bold' fill='{COLOURS[name]}'>{PARTS[name]}</text>"
    )


def _wire(wire: Wire, y: int) -> str:
    colour = COLOURS[wire.group]
    line = f"x1='{BOARD_RIGHT}' y1='{y}' x2='{PART_LEFT}' y2='{y}' stroke='{colour}' stroke-width='2.5'"
    return (
        f"<line {line}/><circle cx='{BOARD_RIGHT}' cy='{y}' r='4' fill='{colour}'/>"
        f"<circle cx='{PART_LEFT}' cy='{y}' r='4' fill='{colour}'/>"
        f"<text x='{BOARD_RIGHT - 12}' y='{y + 5}' text-anchor='end' font-weight='bold'>{wire.pin}</text>"
        f"<text x='{PART_LEFT + 14}' y='{y + 5}'>{escape(wire.label)}</text>"
        f"<text x='{PART_RIGHT - 10}' y='{y + 5}' text-anchor='end' fill='#555'>{escape(wire.meaning)}</text>"
    )


def main() -> None:
    """Write everything."""
    PAGE.write_text(render_page(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
    for path, text in render_pictures().items():
        path.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
