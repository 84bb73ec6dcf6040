"""Numbers with units, as a person types them: "20cm", "0.2 m", "12deg", "12°", "0.21rad"."""

import math
import re

from tapreach.errors import InputError
from tapreach.geometry.finite import finite

_METRES = {"m": 1.0, "cm": 0.01, "mm": 0.001}
_RADIANS = {"rad": 1.0, "deg": math.pi / 180.0, "°": math.pi / 180.0}
_QUANTITY = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*([^\d\s.]*)\s*")


def read_length(name: str, text: str) -> float:
    """Return metres. Raises InputError naming the units that are right."""
    return _read(name, text, _METRES, "20cm, 0.2m or 200mm")


def read_angle(name: str, text: str) -> float:
    """Return radians. Raises InputError naming the units that are right."""
    return _read(name, text, _RADIANS, "12deg, 12° or 0.21rad")


def read_focal_px(text: str, pixels_per_cm: float | None) -> float:
    """Return a focal length in pixels from "1170px", or "24.03cm" and the pixels per cm."""
    value, unit = _split("--focal", text, "1170px or 24.03cm")
    if unit == "px":
        return value
    if unit == "cm":
        if pixels_per_cm is None:
            raise InputError(f"--focal is {text!r} in cm; give --alpha too, the pixels per cm of the picture")
        return value * finite("--alpha", pixels_per_cm)
    raise InputError(f"--focal is {text!r}; give it as 1170px or 24.03cm")


def read_tap(name: str, text: str) -> tuple[float, float]:
    """Return (x, y) [px] from "414,0" or, without a height, "414"."""
    parts = [part.strip() for part in text.split(",")]
    if len(parts) > 2:
        raise InputError(f"{name} is {text!r}; give x or x,y in pixels from the middle of the picture")
    numbers = []
    for part in parts:
        try:
            numbers.append(finite(name, float(part)))
        except ValueError:
            raise InputError(f"{name} is {text!r}; give x or x,y in pixels, such as 414,-35") from None
    return numbers[0], numbers[1] if len(numbers) == 2 else 0.0


def read_pixels(name: str, text: str, example: str) -> list[float]:
    """Return as many numbers [px] as the example has, such as "320,240". Raises InputError showing it."""
    try:
        numbers = [finite(name, float(part)) for part in text.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) != len(example.split(",")):
        raise InputError(f"{name} is {text!r}; give it in pixels of the picture, like {example}")
    return numbers


def _read(name: str, text: str, units: dict[str, float], examples: str) -> float:
    value, unit = _split(name, text, examples)
    if unit not in units:
        raise InputError(f"{name} is {text!r}; give it with its unit, such as {examples}")
    return value * units[unit]


def _split(name: str, text: str, examples: str) -> tuple[float, str]:
    match = _QUANTITY.fullmatch(text)
    if match is None:
        raise InputError(f"{name} is {text!r}; give it as {examples}")
    return finite(name, float(match.group(1))), match.group(2).lower()
