"""Passwords that a person has to type once, drawn letter by letter by whatever is handed in."""

import secrets
from collections.abc import Callable

Draw = Callable[[str], str]
"""Picks one letter of a text, each as likely as any other."""

LETTERS = "abcdefghijkmnpqrstuvwxyzABCDEFGHJKLMNPQRSTUVWXYZ23456789"
"""Without 0, O, 1, l, I and o, which a person mistakes for each other."""
LENGTH = 16
"""93 bits: not to be guessed, also by who recorded the hotspot's handshake."""

draw_secretly: Draw = secrets.choice
"""The operating system's own randomness; tests hand in another."""


def secret_text(draw: Draw, length: int = LENGTH) -> str:
    """Return a fresh password."""
    return "".join(draw(LETTERS) for _ in range(length))
