"""The drawing of the supply: one battery, what hangs on it, and the ground that all of it shares."""

WIDTH, HEIGHT = 760, 330
RED, BLACK, BLUE = "#c0392b", "#222222", "#1f6fb2"
TAKERS = (
    ("H-bridge", "VS / VM, straight from the battery", RED),
    ("5 V regulator, 3 A", "servos, and nothing else", RED),
    ("5 V regulator, 3 A", "Raspberry Pi, where there is one", RED),
    ("board", "VIN; or by USB from the Pi", RED),
)
LEFT, TAKER_LEFT, TAKER_RIGHT, TOP, ROW = 30, 400, 730, 40, 58


def power_drawing() -> str:
    """Return the drawing as SVG."""
    words = "font-family='DejaVu Sans, Verdana, sans-serif' font-size='13'"
    rail, ground = 340, HEIGHT - 36
    last = TOP + (len(TAKERS) - 1) * ROW
    parts = [
        f"<rect width='{WIDTH}' height='{HEIGHT}' fill='white'/>",
        _box(LEFT, TOP - 22, 110, "battery", "7.4 V, 2 cells"),
        _box(LEFT + 150, TOP - 22, 62, "fuse", "5 A"),
        _box(LEFT + 232, TOP - 22, 66, "switch", ""),
        _line(LEFT + 110, TOP, LEFT + 150, TOP, RED),
        _line(LEFT + 212, TOP, LEFT + 232, TOP, RED),
        _line(LEFT + 298, TOP, rail, TOP, RED),
        _line(rail, TOP, rail, last, RED),
        _line(LEFT + 55, TOP + 22, LEFT + 55, ground, BLACK),
        _line(LEFT + 55, ground, TAKER_RIGHT, ground, BLACK),
        f"<text x='{LEFT + 70}' y='{ground + 22}'>ground of battery, board, bridge, servos, encoders and Pi: "
        "all tied together</text>",
    ]
    for index, (name, what, colour) in enumerate(TAKERS):
        y = TOP + index * ROW
        parts += [_line(rail, y, TAKER_LEFT, y, colour), _box(TAKER_LEFT, y - 22, 330, name, what)]
    head = f"<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {WIDTH} {HEIGHT}' width='{WIDTH}' {words}>"
    return "\n".join([head, *parts, "</svg>", ""])


def _box(x: int, y: int, width: int, name: str, what: str) -> str:
    middle = x + width / 2
    below = (
        f"<text x='{middle:g}' y='{y + 36}' text-anchor='middle' fill='#555'>{what}</text>" if what else ""
    )
    name_y = y + (18 if what else 27)
    frame = "rx='6' fill='#fafafa' stroke='#444' stroke-width='1.5'"
    return (
        f"<rect x='{x}' y='{y}' width='{width}' height='44' {frame}/>"
        f"<text x='{middle:g}' y='{name_y}' text-anchor='middle' font-weight='bold'>{name}</text>{below}"
    )


def _line(x1: int, y1: int, x2: int, y2: int, colour: str) -> str:
    ends = f"x1='{x1}' y1='{y1}' x2='{x2}' y2='{y2}'"
    return f"<line {ends} stroke='{colour}' stroke-width='3' stroke-linecap='round'/>"
