"""On which line of a TOML text a key stands: `tomllib` keeps no positions."""

import re
from collections import Counter

KeyPath = tuple[str | int, ...]

_PART = r"""(?:[A-Za-z0-9_-]+|"[^"]*"|'[^']*')"""
_DOTTED = rf"{_PART}(?:\s*\.\s*{_PART})*"
_HEADER = re.compile(rf"^\s*(\[\[?)\s*({_DOTTED})\s*\]")
_ASSIGNMENT = re.compile(rf"^\s*({_DOTTED})\s*=\s*(.*)$")
_INLINE_KEY = re.compile(rf"(?:^|[{{,])\s*({_PART})\s*=")
_STRING = re.compile(r'"(?:\\.|[^"\\])*"|' + r"'[^']*'")


def find_line(text: str, path: KeyPath) -> int | None:
    """Return the 1-based line of the key `path`, or of the nearest enclosing key, or None."""
    lines = key_lines(text)
    for length in range(len(path), 0, -1):
        if path[:length] in lines:
            return lines[path[:length]]
    return None


def key_lines(text: str) -> dict[KeyPath, int]:
    """Map every table, array element and key of a valid TOML text to the line where it begins."""
    found: dict[KeyPath, int] = {}
    elements: Counter[KeyPath] = Counter()
    table: KeyPath = ()
    depth = 0
    quotes: str | None = None
    for number, line in enumerate(text.splitlines(), start=1):
        if quotes:  # inside a multi-line string nothing is a key
            quotes = None if quotes in line else quotes
            continue
        bare = _STRING.sub(lambda match: match.group().replace("#", " "), line).split("#", 1)[0]
        if depth == 0 and (header := _HEADER.match(bare)):
            table = _enter(header, elements)
            found.setdefault(table, number)
            continue
        if depth == 0 and (assignment := _ASSIGNMENT.match(bare)):
            path = table + _parts(assignment.group(1))
            _note(found, path, number)
            bare = assignment.group(2)
            for key in _INLINE_KEY.findall(bare) if bare.startswith("{") else ():
                found.setdefault((*path, *_parts(key)), number)
        quotes = next((q for q in ('"""', "'''") if bare.count(q) % 2), None)
        depth += _balance(bare)
    return found


def _enter(header: re.Match[str], elements: "Counter[KeyPath]") -> KeyPath:
    """Return the path of the table that a header opens, with the indices of arrays of tables."""
    parts = _parts(header.group(2))
    path: KeyPath = ()
    for part in parts[:-1]:
        path = _newest((*path, part), elements)
    path = (*path, parts[-1])
    if header.group(1) == "[[":
        elements[path] += 1
    return _newest(path, elements)


def _newest(path: KeyPath, elements: "Counter[KeyPath]") -> KeyPath:
    return (*path, elements[path] - 1) if path in elements else path


def _note(found: dict[KeyPath, int], path: KeyPath, number: int) -> None:
    for length in range(1, len(path) + 1):
        found.setdefault(path[:length], number)


def _parts(dotted: str) -> tuple[str, ...]:
    return tuple(part.strip("\"'") for part in re.findall(_PART, dotted))


def _balance(text: str) -> int:
    plain = _STRING.sub("", text)
    return sum(plain.count(c) for c in "[{") - sum(plain.count(c) for c in "]}")
