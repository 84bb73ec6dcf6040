"""Textures of floors, walls, furniture and things outside. Pixels are (rows, columns, 3)."""

from collections.abc import Callable

import numpy as np
from asset_drawing import Pixels, flat, noise, streaks
from PIL import Image, ImageDraw

Colour = tuple[int, int, int]


def planks() -> Pixels:
    """Oak floorboards, 1.6 m square: 16 rows of 10 cm boards."""
    side, rows = 1024, 16
    rng = np.random.default_rng(1)
    picture = flat(side, side, (176, 134, 92))
    grain = streaks(side, side, 2, 140) * 0.045 + streaks(side, side, 3, 24) * 0.022
    knots = np.clip(noise(side, side, 4, 6, 4) - 0.95, 0, 1)
    picture *= (1 + grain - 0.55 * knots + 0.06 * noise(side, side, 5, 4, 7))[..., None]
    high = side // rows
    for row in range(rows):
        top = row * high
        starts = np.sort(rng.integers(0, side, 2)) if row % 2 else np.sort(rng.integers(0, side, 3))
        for start, end in zip(starts, [*starts[1:], starts[0] + side], strict=True):
            columns = np.arange(start, end) % side
            tone = rng.uniform(0.78, 1.14) * np.array([1.0, rng.uniform(0.95, 1.02), rng.uniform(0.86, 1.04)])
            picture[top : top + high, columns] *= tone
            picture[top : top + high, np.arange(start, start + 2) % side] *= 0.45
        picture[top : top + 2] *= 0.5
        picture[top + 2 : top + 4] *= 1.08
    return picture


def tiles() -> Pixels:
    """Kitchen tiles: light stone, 4 by 4, dark joints."""
    side, count = 768, 4
    rng = np.random.default_rng(11)
    picture = flat(side, side, (196, 190, 178)) * (1 + 0.07 * noise(side, side, 12, 5, 7))[..., None]
    veins = np.abs(noise(side, side, 13, 3, 6))
    picture *= (1 - 0.16 * np.exp(-((veins / 0.035) ** 2)))[..., None]
    edge = side // count
    for i in range(count):
        for j in range(count):
            picture[i * edge : (i + 1) * edge, j * edge : (j + 1) * edge] *= rng.uniform(0.9, 1.05)
    for k in range(count):
        picture[k * edge : k * edge + 5] = picture[:, k * edge : k * edge + 5] = (118, 112, 104)
    return picture


def carpet() -> Pixels:
    """A looped grey-blue carpet."""
    side = 640
    speckle = np.random.default_rng(21).standard_normal((side, side))
    shade = 1 + 0.07 * speckle + 0.09 * noise(side, side, 22, 5, 6)
    return flat(side, side, (112, 116, 128)) * shade[..., None]


def plain() -> Pixels:
    """A poured floor with next to nothing to see: hard for any tracker."""
    return flat(256, 256, (178, 176, 170)) * (1 + 0.008 * noise(256, 256, 31, 4, 4))[..., None]


def paving() -> Pixels:
    """Concrete slabs with moss in the joints."""
    side, count = 1024, 4
    rng = np.random.default_rng(41)
    stains = 0.10 * noise(side, side, 42, 4, 8) + 0.05 * rng.standard_normal((side, side))
    picture = flat(side, side, (156, 150, 140)) * (1 + stains)[..., None]
    edge = side // count
    joint = np.zeros((side, side), dtype=bool)
    for row in range(count):
        shift = (row % 2) * edge // 2
        for column in range(count):
            columns = (np.arange(edge) + column * edge + shift) % side
            picture[row * edge : (row + 1) * edge, columns] *= rng.uniform(0.86, 1.08)
            joint[row * edge : (row + 1) * edge, columns[:7]] = True
        joint[row * edge : row * edge + 7] = True
    moss = flat(side, side, (74, 84, 50)) * (1 + 0.3 * noise(side, side, 43, 16, 5))[..., None]
    picture[joint] = moss[joint]
    return picture


def grass() -> Pixels:
    """Mown grass with blades and a few daisies."""
    side = 640
    rng = np.random.default_rng(51)
    picture = flat(side, side, (84, 112, 48)) * (1 + 0.18 * noise(side, side, 52, 4, 7))[..., None]
    sheet = Image.fromarray(np.clip(picture, 0, 255).astype(np.uint8))
    draw = ImageDraw.Draw(sheet)
    for _ in range(9000):
        x, y = rng.integers(0, side, 2)
        lean, length = rng.normal(0, 3), rng.uniform(4, 11)
        green = (int(rng.integers(52, 132)), int(rng.integers(92, 164)), int(rng.integers(30, 66)))
        draw.line([x, y, x + lean, y - length], fill=green, width=1)
    for _ in range(26):
        x, y = rng.integers(6, side - 6, 2)
        draw.ellipse([x - 3, y - 3, x + 3, y + 3], fill=(236, 236, 226))
        draw.ellipse([x - 1, y - 1, x + 1, y + 1], fill=(232, 190, 40))
    return np.asarray(sheet, dtype=float)


def leaves() -> Pixels:
    """A hedge, or the crown of a pot plant."""
    side = 384
    rng = np.random.default_rng(61)
    sheet = Image.new("RGB", (side, side), (26, 44, 20))
    draw = ImageDraw.Draw(sheet)
    for index in range(1500):
        x, y = rng.integers(0, side, 2)
        radius, light = rng.uniform(4, 9), 0.45 + 0.65 * index / 1500
        green = tuple(int(light * c * rng.uniform(0.8, 1.2)) for c in (84, 132, 52))
        draw.ellipse([x - radius, y - radius * 0.55, x + radius, y + radius * 0.55], fill=green)
        draw.line([x - radius, y, x + radius, y], fill=tuple(int(c * 0.8) for c in green), width=1)
    return np.asarray(sheet, dtype=float)


def bark() -> Pixels:
    """Rough wood for trunks and fences."""
    picture = flat(256, 256, (122, 96, 70))
    return picture * (1 + 0.10 * streaks(256, 256, 71, 60) + 0.05 * noise(256, 256, 72, 8, 5))[..., None]


def wood() -> Pixels:
    """Planed beech for furniture."""
    picture = flat(384, 384, (190, 146, 100))
    return picture * (1 + 0.055 * streaks(384, 384, 81, 120) + 0.06 * noise(384, 384, 82, 3, 5))[..., None]


def wallpaper() -> Pixels:
    """Warm plaster-white paper with a faint damask of lozenges."""
    side = 512
    rows, columns = np.mgrid[0:side, 0:side] * (2 * np.pi * 8 / side)
    lozenge = np.tanh(4 * np.cos(rows) * np.cos(columns) + 0.6 * np.cos(2 * rows) * np.cos(2 * columns))
    shade = 1 + 0.022 * lozenge + 0.025 * noise(side, side, 91, 3, 7)
    return flat(side, side, (214, 206, 190)) * shade[..., None]


def brick() -> Pixels:
    """A brick wall, 16 courses."""
    high, wide, courses, across = 512, 512, 16, 6
    rng = np.random.default_rng(101)
    picture = flat(high, wide, (176, 168, 156))
    course, brick_wide = high // courses, wide / across
    for row in range(courses):
        for column in range(across):
            left = int((column + 0.5 * (row % 2)) * brick_wide)
            columns = np.arange(left + 3, left + int(brick_wide)) % wide
            picture[row * course + 3 : (row + 1) * course, columns] = np.array([158, 84, 62]) * rng.uniform(
                0.72, 1.15
            )
    return picture * (1 + 0.09 * noise(high, wide, 102, 8, 6))[..., None]


def fabric() -> Pixels:
    """Woven teal upholstery."""
    side = 256
    rows, columns = np.mgrid[0:side, 0:side]
    weave = 0.06 * np.sign(np.sin(rows * np.pi / 2) * np.sin(columns * np.pi / 2))
    shade = 1 + weave + 0.08 * noise(side, side, 111, 4, 6)
    return flat(side, side, (54, 108, 112)) * shade[..., None]


def rug() -> Pixels:
    """A patterned rug with a border."""
    high, wide = 448, 672
    rng = np.random.default_rng(121)
    sheet = Image.new("RGB", (wide, high), (128, 34, 38))
    draw = ImageDraw.Draw(sheet)
    for inset, colour in (
        (10, (222, 200, 160)),
        (20, (34, 46, 82)),
        (62, (222, 200, 160)),
        (70, (142, 42, 40)),
    ):
        draw.rectangle([inset, inset, wide - 1 - inset, high - 1 - inset], fill=colour)
    for x in range(36, wide - 20, 30):
        for y in (41, high - 41):
            draw.regular_polygon((x, y, 11), 4, fill=(206, 160, 72))
    for y in range(36, high - 20, 30):
        for x in (41, wide - 41):
            draw.regular_polygon((x, y, 11), 4, fill=(206, 160, 72))
    for x in range(120, wide - 100, 72):
        for y in range(120, high - 100, 70):
            draw.regular_polygon((x, y, 30), 4, fill=(38, 52, 90))
            draw.regular_polygon((x, y, 19), 8, fill=(214, 184, 126))
            draw.regular_polygon((x, y, 9), 4, fill=(150, 44, 40))
    woven = 1 + 0.06 * rng.standard_normal((high, wide)) + 0.04 * noise(high, wide, 122, 4, 5)
    return np.asarray(sheet, dtype=float) * woven[..., None]


def books() -> Pixels:
    """Spines of books on a board."""
    high, wide = 384, 384
    rng = np.random.default_rng(131)
    sheet = Image.new("RGB", (wide, high), (44, 34, 26))
    draw = ImageDraw.Draw(sheet)
    palette = [
        (148, 38, 42),
        (32, 66, 110),
        (212, 190, 142),
        (42, 92, 66),
        (216, 140, 42),
        (78, 52, 96),
        (226, 224, 214),
    ]
    x = 2
    while x < wide - 10:
        thick, tall = int(rng.integers(16, 40)), int(rng.integers(270, 372))
        colour = palette[int(rng.integers(len(palette)))]
        draw.rectangle([x, high - tall, x + thick, high], fill=colour, outline=(20, 18, 16))
        band = high - tall + int(rng.integers(14, 50))
        draw.rectangle([x + 3, band, x + thick - 3, band + 9], fill=(236, 220, 170))
        for y in range(band + 24, high - 40, 9):
            draw.line(
                [x + thick // 2, y, x + thick // 2, y + int(rng.integers(3, 8))],
                fill=(240, 232, 214),
                width=3,
            )
        x += thick + 1
    return np.asarray(sheet, dtype=float)


def view() -> Pixels:
    """What is seen through the window: sky, hills, trees."""
    high, wide = 384, 512
    rng = np.random.default_rng(141)
    share = np.linspace(0, 1, high)[:, None, None]
    picture = (1 - share) * np.array([126, 176, 226.0]) + share * np.array([226, 236, 242.0])
    cloud = np.clip(noise(high, wide, 142, 3, 6) - 0.15, 0, 0.6)[..., None] / 0.6
    picture = picture * (1 - cloud) + 250 * cloud
    sheet = Image.fromarray(picture.astype(np.uint8))
    draw = ImageDraw.Draw(sheet)
    for base, colour in ((0.66, (134, 160, 150)), (0.76, (104, 138, 92)), (0.86, (78, 116, 60))):
        ridge = base * high + 26 * noise(1024, 1024, int(base * 1000), 4, 4)[0, :wide]
        draw.polygon([(0, high), *((x, float(y)) for x, y in enumerate(ridge)), (wide, high)], fill=colour)
    for x in rng.integers(0, wide, 16):
        y, radius = int(rng.integers(300, 350)), int(rng.integers(12, 30))
        draw.ellipse([x - radius, y - radius, x + radius, y + radius], fill=(58, 92, 46))
    return np.asarray(sheet, dtype=float)


def poster_mountain() -> Pixels:
    """A travel poster."""
    sheet = Image.new("RGB", (256, 352), (238, 226, 200))
    draw = ImageDraw.Draw(sheet)
    draw.rectangle([16, 16, 239, 280], fill=(242, 176, 92))
    draw.ellipse([150, 46, 210, 106], fill=(252, 234, 160))
    draw.polygon(
        [(16, 250), (90, 96), (150, 210), (180, 160), (239, 262), (239, 280), (16, 280)], fill=(54, 74, 112)
    )
    draw.polygon([(72, 134), (90, 96), (108, 132), (94, 144), (84, 130)], fill=(246, 246, 250))
    draw.polygon([(16, 280), (16, 240), (110, 262), (239, 236), (239, 280)], fill=(40, 90, 72))
    draw.rectangle([48, 300, 207, 312], fill=(54, 74, 112))
    draw.rectangle([80, 322, 175, 330], fill=(196, 92, 60))
    return np.asarray(sheet, dtype=float)


def poster_shapes() -> Pixels:
    """A print of plain shapes."""
    sheet = Image.new("RGB", (256, 352), (244, 242, 234))
    draw = ImageDraw.Draw(sheet)
    draw.ellipse([40, 50, 180, 190], fill=(206, 62, 48))
    draw.rectangle([120, 150, 222, 300], fill=(38, 84, 148))
    draw.polygon([(30, 310), (100, 190), (160, 310)], fill=(236, 186, 54))
    draw.line([30, 40, 226, 320], fill=(20, 20, 24), width=5)
    return np.asarray(sheet, dtype=float)


def door() -> Pixels:
    """A panelled door, painted."""
    sheet = Image.new("RGB", (256, 512), (226, 220, 206))
    draw = ImageDraw.Draw(sheet)
    for left, top, right, bottom in (
        (36, 40, 112, 210),
        (144, 40, 220, 210),
        (36, 250, 112, 470),
        (144, 250, 220, 470),
    ):
        draw.rectangle([left, top, right, bottom], fill=(212, 205, 190), outline=(166, 158, 142), width=4)
        draw.line([left, top, right, top], fill=(140, 132, 118), width=4)
    draw.ellipse([12, 236, 30, 254], fill=(150, 130, 80))
    return np.asarray(sheet, dtype=float) * (1 + 0.015 * noise(512, 512, 151, 4, 5)[:, :256])[..., None]


Drawing = tuple[Callable[[], Pixels], int]

SURFACES: dict[str, Drawing] = {
    "planks": (planks, 40),
    "tiles": (tiles, 24),
    "carpet": (carpet, 20),
    "plain": (plain, 16),
    "paving": (paving, 32),
    "grass": (grass, 40),
    "leaves": (leaves, 32),
    "bark": (bark, 24),
    "wood": (wood, 24),
    "wallpaper": (wallpaper, 16),
    "brick": (brick, 32),
    "fabric": (fabric, 20),
    "rug": (rug, 40),
    "books": (books, 32),
    "view": (view, 64),
    "poster_mountain": (poster_mountain, 24),
    "poster_shapes": (poster_shapes, 24),
    "door": (door, 24),
}
