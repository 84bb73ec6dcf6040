"""Labels of cans, bottles, cups, balls and boxes. Each returns pixels of shape (rows, columns, 3)."""

from collections.abc import Callable
from functools import partial

import numpy as np
from asset_drawing import Pixels, flat, noise, streaks
from PIL import Image, ImageDraw, ImageFont

Colour = tuple[int, int, int]


def _write(
    draw: ImageDraw.ImageDraw, centre: tuple[float, float], text: str, size: int, ink: Colour, rim: Colour
) -> None:
    font = ImageFont.load_default(size=size)
    draw.text(
        centre, text, fill=ink, font=font, stroke_width=max(1, size // 16), stroke_fill=rim, anchor="mm"
    )


def _worn(sheet: Image.Image, seed: int, depth: float = 0.05) -> Pixels:
    pixels = np.asarray(sheet, dtype=float)
    return pixels * (1 + depth * noise(512, 512, seed, 4, 6)[: pixels.shape[0], : pixels.shape[1]])[..., None]


def can_label(text: str, ground: Colour, band: Colour, seed: int) -> Pixels:
    """Wrap for a can: metal rims, waves, the name on both sides."""
    wide, high = 512, 256
    sheet = Image.new("RGB", (wide, high), ground)
    draw = ImageDraw.Draw(sheet)
    x = np.arange(wide)
    for offset, colour in ((0, band), (16, (250, 246, 236)), (28, ground)):
        wave = 176 + offset + 16 * np.sin(2 * np.pi * x / 256)
        draw.polygon([(0, high), *zip(x.tolist(), wave.tolist(), strict=True), (wide, high)], fill=colour)
    for centre in (128, 384):
        _write(draw, (centre, 104), text, 74, (252, 250, 244), (40, 12, 12))
        draw.ellipse([centre - 34, 36, centre + 34, 48], fill=band)
    for bar in range(12):
        draw.line(
            [238 + bar * 3, 66, 238 + bar * 3, 116],
            fill=(20, 20, 20) if bar % 3 else (245, 245, 245),
            width=2,
        )
    draw.rectangle([0, 0, wide, 17], fill=(198, 200, 204))
    draw.rectangle([0, high - 14, wide, high], fill=(188, 190, 194))
    return _worn(sheet, seed)


def bottle_label(text: str, glass: Colour, paper: Colour, ink: Colour, seed: int) -> Pixels:
    """Wrap for a bottle: cap, glass, a paper label below the middle."""
    wide, high = 512, 320
    sheet = Image.new("RGB", (wide, high), glass)
    draw = ImageDraw.Draw(sheet)
    draw.rectangle([0, 0, wide, 26], fill=ink)
    draw.rectangle([0, 140, wide, 276], fill=paper)
    draw.rectangle([0, 148, wide, 153], fill=ink)
    draw.rectangle([0, 262, wide, 267], fill=ink)
    for centre in (128, 384):
        _write(draw, (centre, 200), text, 58, ink, paper)
        for leaf in range(-3, 4):
            draw.ellipse([centre + leaf * 26 - 9, 238, centre + leaf * 26 + 9, 252], fill=glass)
    return _worn(sheet, seed, 0.04)


def box_label(text: str, ground: Colour, panel: Colour, ink: Colour, seed: int) -> Pixels:
    """One face of a packet."""
    side = 256
    sheet = Image.new("RGB", (side, side), ground)
    draw = ImageDraw.Draw(sheet)
    rng = np.random.default_rng(seed)
    draw.rectangle([14, 62, side - 15, 168], fill=panel, outline=ink, width=5)
    _write(draw, (side / 2, 115), text, 66 if len(text) < 5 else 48, ink, panel)
    for _ in range(12):
        x, y, radius = rng.integers(14, 240), rng.integers(184, 240), rng.integers(5, 13)
        draw.ellipse([x - radius, y - radius, x + radius, y + radius], fill=panel)
    for index in range(7):
        draw.rectangle([18 + index * 34, 16, 36 + index * 34, 44], fill=panel if index % 2 else ink)
    draw.rectangle([0, 0, side - 1, side - 1], outline=tuple(int(c * 0.7) for c in ground), width=4)
    return _worn(sheet, seed)


def crate() -> Pixels:
    """One face of a wooden crate."""
    side = 320
    pixels = flat(side, side, (164, 122, 78)) * (1 + 0.08 * streaks(side, side, 5, 90))[..., None]
    sheet = Image.fromarray(np.clip(pixels, 0, 255).astype(np.uint8))
    draw = ImageDraw.Draw(sheet)
    for y in range(0, side, 64):
        draw.rectangle([0, y, side, y + 4], fill=(62, 42, 24))
    for edge in ([0, 0, 40, side], [side - 41, 0, side, side]):
        draw.rectangle(edge, fill=(142, 102, 62), outline=(70, 48, 28), width=3)
        for y in range(32, side, 64):
            draw.ellipse([edge[0] + 16, y - 4, edge[0] + 25, y + 5], fill=(66, 62, 60))
    _write(draw, (side / 2, 160), "FRAGILE", 40, (60, 30, 20), (150, 110, 70))
    return _worn(sheet, 6, 0.07)


def cardboard() -> Pixels:
    """One face of a parcel: tape, arrows, a sticker."""
    side = 320
    pixels = flat(side, side, (186, 146, 100)) * (1 + 0.025 * streaks(side, side, 7, 20).T)[..., None]
    sheet = Image.fromarray(np.clip(pixels, 0, 255).astype(np.uint8))
    draw = ImageDraw.Draw(sheet)
    draw.rectangle([140, 0, 180, side], fill=(204, 176, 128))
    draw.rectangle([30, 40, 118, 100], fill=(240, 238, 230), outline=(60, 60, 60), width=2)
    for row in range(4):
        draw.line([38, 52 + row * 12, 38 + 60 - row * 9, 52 + row * 12], fill=(50, 50, 60), width=4)
    for x in (222, 270):
        draw.polygon([(x, 210), (x + 18, 240), (x - 18, 240)], fill=(52, 36, 24))
        draw.rectangle([x - 6, 240, x + 6, 276], fill=(52, 36, 24))
    return _worn(sheet, 8)


def ball(kind: str) -> Pixels:
    """Wrap for a ball: beach ball stripes or a football's patches."""
    wide, high = 384, 192
    if kind == "beach":
        colours = [(226, 52, 44), (246, 244, 236), (42, 104, 190), (246, 206, 56)] * 2
        strip = np.repeat(np.array(colours, dtype=float), wide // 8, axis=0)
        return _worn(Image.fromarray(np.broadcast_to(strip, (high, wide, 3)).astype(np.uint8)), 9, 0.03)
    sheet = Image.new("RGB", (wide, high), (236, 234, 226))
    draw = ImageDraw.Draw(sheet)
    for row, (y, count) in enumerate(((20, 3), (68, 6), (124, 6), (172, 3))):
        for index in range(count):
            x = (index + 0.5 * (row % 2)) * wide / count + 20
            draw.regular_polygon((x % wide, y, 19), 5, rotation=36 * row, fill=(26, 28, 32))
    return _worn(sheet, 10, 0.04)


def cup(ground: Colour, dot: Colour) -> Pixels:
    """Wrap for a mug: glaze with dots, inside plain."""
    wide, high = 384, 192
    sheet = Image.new("RGB", (wide, high), ground)
    draw = ImageDraw.Draw(sheet)
    for row, y in enumerate(range(112, high - 8, 24)):
        for x in range(0, wide, 32):
            centre = x + 16 * (row % 2)
            draw.ellipse([centre - 7, y - 7, centre + 7, y + 7], fill=dot)
    return _worn(sheet, 12, 0.03)


Drawing = tuple[Callable[[], Pixels], int]

LABELS: dict[str, Drawing] = {
    "can_cola": (partial(can_label, "COLA", (196, 26, 34), (244, 204, 70), 1), 48),
    "can_beans": (partial(can_label, "BEANS", (24, 112, 122), (240, 150, 60), 2), 48),
    "can_soup": (partial(can_label, "SOUP", (232, 178, 48), (186, 52, 30), 3), 48),
    "bottle_juice": (partial(bottle_label, "JUICE", (34, 116, 62), (238, 232, 208), (196, 66, 28), 1), 40),
    "bottle_water": (partial(bottle_label, "WATER", (126, 178, 206), (240, 246, 250), (24, 78, 150), 2), 40),
    "bottle_sauce": (partial(bottle_label, "SAUCE", (150, 30, 24), (246, 236, 200), (92, 14, 14), 3), 40),
    "box_tea": (partial(box_label, "TEA", (206, 132, 38), (250, 242, 222), (60, 74, 132), 1), 40),
    "box_mint": (partial(box_label, "MINT", (44, 136, 104), (240, 248, 240), (16, 74, 58), 2), 40),
    "box_oats": (partial(box_label, "OATS", (58, 92, 166), (250, 240, 206), (164, 46, 40), 3), 40),
    "box_crate": (crate, 32),
    "box_cardboard": (cardboard, 32),
    "ball_beach": (partial(ball, "beach"), 24),
    "ball_football": (partial(ball, "football"), 16),
    "cup_blue": (partial(cup, (236, 234, 226), (42, 84, 156)), 16),
    "cup_red": (partial(cup, (188, 48, 44), (246, 232, 206)), 16),
}
