"""From what came over the socket to a message, or to the answer that says what is wrong with it."""

from typing import Any

from pydantic import ValidationError
from pydantic_core import from_json

from tapreach.server.messages import Ack, FromPage, from_page

LONGEST_TEXT = 16_384
JSON_NAMES = {
    list: "an array",
    str: "a string",
    int: "a number",
    float: "a number",
    bool: "true or false",
    type(None): "null",
}


def parsed(raw: str | bytes) -> FromPage | Ack:
    """Return the message, or the Ack that refuses it and names the problem."""
    if isinstance(raw, bytes):
        return _refused(None, "binary message; send JSON text")
    if len(raw) > LONGEST_TEXT:
        return _refused(None, f"message of {len(raw)} characters; at most {LONGEST_TEXT} are read")
    try:
        value = from_json(raw)
    except ValueError as error:
        return _refused(None, f"not JSON: {error}")
    if not isinstance(value, dict):
        return _refused(None, f"{JSON_NAMES[type(value)]}; a message is an object with 'type' and 'seq'")
    try:
        # strict: a number in quotes is no number.
        return from_page.validate_json(raw, strict=True)
    except ValidationError as error:
        return _refused(_seq_of(value), _first_problem(error))


def _seq_of(value: dict[str, Any]) -> int | None:
    seq = value.get("seq")
    return seq if type(seq) is int and 1 <= seq < 2**53 else None


def _refused(seq: int | None, reason: str) -> Ack:
    return Ack(seq=seq, ok=False, reason=reason)


def _first_problem(error: ValidationError) -> str:
    first = error.errors(include_url=False, include_context=False)[0]
    where = ".".join(str(part) for part in first["loc"][1:])
    given = repr(first["input"])
    shown = given if len(given) <= 60 else given[:57] + "..."
    return f"{where}: {first['msg']}, got {shown}" if where else f"{first['msg']}, got {shown}"
